#include "base/service_manager.h"

#include <spdlog/spdlog.h>
#include <systemd/sd-daemon.h>

#include <cstring>

#include "base/logfmt.h"

namespace affskel::base {

void notify_service_manager(ServiceState state) {
  const char* text = state == ServiceState::kReady ? "READY=1" : "STOPPING=1";
  if (const int told = sd_notify(0, text); told < 0) {
    spdlog::warn(logfmt("service_manager_not_told", {{"state", text}, {"message", std::strerror(-told)}}));
  }
}

}  // namespace affskel::base
