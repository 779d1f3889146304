#include "client/commands/shared/destination.h"

#include "client/base/error.h"

namespace affskel::client {

Destination destination_of(const std::string& output, const std::string& format, const Console& console) {
  Destination destination{output, format};
  if (destination.is_stdout() && console.style().json) {
    throw ClientError(ExitCode::kUsage, "--json and -o - both want standard output");
  }
  return destination;
}

}  // namespace affskel::client
