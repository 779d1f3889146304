#pragma once

#include "net/tls_files.h"

namespace affskel::server {

/// Sets up TLS for gRPC: of what a client offers, HTTP/2 and nothing else, and without what a peer could use
/// to make the server keep something for it.
void speak_http2(SSL_CTX* context);

}  // namespace affskel::server
