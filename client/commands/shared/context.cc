#include "client/commands/shared/context.h"

#include "client/commands/shared/notices.h"

namespace affskel::client {

Session& Context::session() {
  if (!session_) {
    session_.emplace(
        choose_server(global_.server, environment_, global_.access), environment_,
        [&console = console_](const Notice& notice) { say(console, notice); }, policy_);
  }
  return *session_;
}

}  // namespace affskel::client
