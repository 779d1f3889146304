#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <system_error>

#include "base/end_limit.h"
#include "base/temporary_files.h"
#include "client/cli/value_checks.h"
#include "client/commands/commands.h"
#include "client/web/open_browser.h"
#include "client/web/tls_identity.h"
#include "client/web/web_service.h"
#include "http/server.h"
#include "wire/address.h"

namespace affskel::client {
namespace {

struct WebCommandOptions {
  std::string http = "127.0.0.1:0";
  std::string tls_cert, tls_key;
  bool no_open = false;
};

// A request waits no longer for a server that is away, nor for a worker.
constexpr std::chrono::seconds kPatience{10};
constexpr std::chrono::minutes kArtifactPatience{10};

// For what is worked on when it is told to leave; the server has what it was given.
constexpr std::chrono::seconds kLongestEnd{30};
constexpr const char* kStuck = "event=stuck message=\"the end takes too long; leaving without it\"";

wire::Address http_address(const WebCommandOptions& options) {
  wire::Address address;
  try {
    address = wire::parse_address(options.http);
  } catch (const std::invalid_argument& error) {
    throw ClientError(ExitCode::kUsage, std::string("--http: ") + error.what());
  }
  if (address.is_unix) throw ClientError(ExitCode::kUsage, "--http: browsers need HOST:PORT");
  if (!address.is_local() && options.tls_cert.empty()) {
    throw ClientError(ExitCode::kUsage, "--http: other machines can reach " + address.target() +
                                            ": give --tls-cert and --tls-key for HTTPS");
  }
  return address;
}

// Whose the page is.  On a loopback address its user's, who acts as the client does, unless the server
// refuses the client; anywhere else people sign in.
// @throws ClientError kNotAllowed when they could not, since the server asks for no token.
bool is_personal(const Backend& backend, const wire::Address& address) {
  if (address.is_local() && !backend.refuses_us()) return true;
  if (!backend.refuses_strangers()) {
    throw ClientError(
        ExitCode::kNotAllowed,
        "the server asks nobody for a token, so that whoever reaches the page could do everything; "
        "see affskel-server token --help");
  }
  return false;
}

// As a browser writes it; of all addresses of this machine the one that it has itself.
std::string page_address(const wire::Address& address, bool secure) {
  wire::Address shown = address;
  if (shown.host == "0.0.0.0" || shown.host == "::") shown.host = "localhost";
  return (secure ? "https://" : "http://") + shown.target() + "/";
}

// @throws ClientError kUsage when it cannot listen there.
std::unique_ptr<http::Server> listen(const wire::Address& address, TlsIdentity* identity,
                                     http::AdmitRequest admit) {
  http::TlsContexts contexts;
  if (identity != nullptr) contexts = [identity] { return identity->context(); };
  try {
    return std::make_unique<http::Server>(address, contexts, std::move(admit));
  } catch (const std::system_error& error) {
    throw ClientError(ExitCode::kUsage,
                      "cannot listen on " + address.target() + ": " + error.code().message());
  }
}

void run_web(Context& context, const WebCommandOptions& options, const GlobalOptions& global) {
  wire::Address address = http_address(options);
  std::optional<TlsIdentity> identity;
  if (!options.tls_cert.empty()) identity.emplace(options.tls_cert, options.tls_key);
  std::stop_source stop;
  RetryPolicy policy;
  policy.patience = kPatience;
  policy.artifact_patience = kArtifactPatience;
  policy.stop = stop.get_token();
  const Backend backend(context.environment(), global.server, global.access, policy);
  WebOptions web;
  web.personal = is_personal(backend, address);
  web.secure = identity.has_value();
  web.hosts.loopback = address.is_local();
  web.repair_limit = std::chrono::seconds(global.budgets.repair_limit_s);
  if (identity) web.hosts.certified = [&](const std::string& name) { return identity->names(name); };

  std::unique_ptr<WebService> service;
  {
    const auto http = listen(address, identity ? &*identity : nullptr,
                             [&](const http::Request& head) { return service->admit(head); });
    web.port = address.port = http->port();
    service = std::make_unique<WebService>(backend, web);
    const std::string page = page_address(address, web.secure);
    const auto with_key = [&] { return web.personal ? page + "#key=" + service->new_key() : page; };
    const std::string printed = with_key();
    context.console().result(printed + "\n");
    context.console().document({{"address", printed}, {"mode", web.personal ? "personal" : "sign-in"}});
    const bool opened = !options.no_open &&
                        open_browser(with_key(), service->new_private_path(".html"), context.environment());
    context.console().note(std::string(opened ? "opened it in a browser" : "open it in a browser") +
                           (web.personal ? "; it opens once" : "; people sign in with their tokens") +
                           "; Ctrl-C ends the service, jobs go on");
    base::set_end_limit(
        {.limit = kLongestEnd, .entry = kStuck, .before = []() noexcept { base::remove_guarded_files(); }});
    http->run(true);
    stop.request_stop();
  }
}

void check_options(const CLI::App& web) {
  if (web.count("--tls-cert") != web.count("--tls-key"))
    throw CLI::ValidationError("--tls-cert", "and --tls-key come together");
}

}  // namespace

void add_web(CommandLine& line) {
  const auto options = std::make_shared<WebCommandOptions>();
  CLI::App* command = line.add(
      "web", "The page in a browser: submit, follow, look at, download; prints its address",
      "  affskel-client web\n"
      "  affskel-client --server 127.0.0.1:7060 web --http 127.0.0.1:8080 --no-open\n"
      "  affskel-client web --http 0.0.0.0:8443 --tls-cert lab.pem --tls-key lab.key\n"
      "On a loopback address the page is yours: it acts as this client does, and the address holds a\n"
      "key that opens it once.  Where the server refuses this client, and on any other address, people\n"
      "sign in with their own tokens, and the service can do nothing without them.",
      [options, &line](Context& context) { run_web(context, *options, line.global()); }, check_options);
  command->add_option("--http", options->http, "HOST:PORT to listen on; port 0 takes any free one")
      ->check(non_empty())
      ->capture_default_str()
      ->type_name("ADDR");
  command->add_flag("--no-open", options->no_open, "Do not open the page in a browser");
  command
      ->add_option(
          "--tls-cert", options->tls_cert,
          "Certificate chain for HTTPS, PEM; required off loopback.  Its names are the hosts of the page")
      ->check(non_empty())
      ->type_name("FILE");
  command->add_option("--tls-key", options->tls_key, "Its private key, PEM")
      ->check(non_empty())
      ->type_name("FILE");
}

}  // namespace affskel::client
