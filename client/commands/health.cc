#include <nlohmann/json.hpp>

#include "client/commands/commands.h"

namespace affskel::client {
namespace {

void run_health(Context& context) {
  context.session().require_health();
  context.console().result("serving\n");
  context.console().document({{"health", "serving"}});
}

}  // namespace

void add_health(CommandLine& line) {
  line.add("health", "Whether the server serves, by the gRPC health service; asks once, needs no token",
           "  affskel-client health\n  affskel-client --server unix:data/server.sock health", run_health);
}

}  // namespace affskel::client
