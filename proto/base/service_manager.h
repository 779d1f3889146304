#pragma once

namespace affskel::base {

/// What a service manager wants to know of a service, beyond that its process runs.
enum class ServiceState {
  kReady,     ///< it does what it is there for
  kStopping,  ///< it has begun to leave
};

/// Tells the service manager, by one datagram to the socket that $NOTIFY_SOCKET names, as sd_notify(3) says.
/// Without that variable nothing was asked, and nothing happens.  When it cannot be told, the default logger
/// of spdlog says why: the manager will then end the service for not being ready in time.
void notify_service_manager(ServiceState state);

}  // namespace affskel::base
