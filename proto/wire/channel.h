#pragma once

#include <grpcpp/channel.h>
#include <grpcpp/support/channel_arguments.h>

#include <memory>
#include <string>

#include "wire/address.h"

namespace affskel::wire {

/// What a program shows to a server, and how it knows the server.  All are files, so that no secret stands on
/// a command line.
struct AccessFiles {
  std::string token_file = {};  ///< its first line is the token; empty = none is shown
  std::string tls_ca = {};      ///< PEM, the possible signers of the server's certificate; empty = no TLS
  std::string tls_cert = {};    ///< PEM, this program's own certificate, for servers that ask for one
  std::string tls_key = {};     ///< PEM, its key
};

/// A channel whose calls carry the token of these files.  Token, certificates and key are read again when their
/// files have changed, so that a program that runs for weeks can be given new ones.  From then on the process
/// leaves no core dump.  A Unix socket has no TLS: the files of TLS are for TCP.
/// @throws std::invalid_argument, naming the file, when one cannot be read or has not what it should; and
///   when a token would leave this machine in the clear.
std::shared_ptr<grpc::Channel> make_channel(const Address& address, const AccessFiles& files,
                                            const grpc::ChannelArguments& arguments);

/// The process leaves no core dump from now on, whatever the system's settings: it holds a secret.
void forbid_core_dumps();

}  // namespace affskel::wire
