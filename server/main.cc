#include "base/standard_streams.h"
#include "process/options.h"
#include "process/run.h"

namespace {

[[gnu::section(".preinit_array"),
  gnu::used]] void (*const at_first)(int, char**, char**) = affskel::base::keep_standard_streams;

}  // namespace

int main(int argc, char** argv) {
  const affskel::server::ParsedOptions parsed = affskel::server::parse_options(argc, argv);
  return parsed.exit_code ? *parsed.exit_code : affskel::server::run(parsed.options);
}
