#include "client/commands/shared/context.h"

namespace affskel::client {

Session& Context::session() {
  if (!session_) {
    session_.emplace(choose_server(global_.server, environment_, global_.access), environment_, console_,
                     policy_);
  }
  return *session_;
}

}  // namespace affskel::client
