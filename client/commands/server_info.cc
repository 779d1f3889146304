#include "client/commands/commands.h"
#include "client/text/message_json.h"
#include "client/text/server_text.h"
#include "client/text/time_text.h"

namespace affskel::client {
namespace {

void run_server_info(Context& context) {
  const v1::ServerInfo info = context.session().server_info();
  context.console().result(server_details(info, unix_now_ms()));
  nlohmann::ordered_json document = to_json(info);
  document["address"] = context.session().address();
  context.console().document(document);
}

}  // namespace

void add_server_info(CommandLine& line) {
  line.add("server-info", "Version, workers and queue of the server",
           "  affskel-client server-info\n  affskel-client --server 127.0.0.1:7060 server-info",
           run_server_info);
}

}  // namespace affskel::client
