#include "process/options.h"
#include "process/run.h"

int main(int argc, char** argv) {
  const affskel::server::ParsedOptions parsed = affskel::server::parse_options(argc, argv);
  return parsed.exit_code ? *parsed.exit_code : affskel::server::run(parsed.options);
}
