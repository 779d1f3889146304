#include "stage.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "tools/files.h"

namespace affskel::chaos {
namespace {

using Clock = std::chrono::steady_clock;
// A call waits for the server, and an end is waited for between two of them: neither is missed for long.
constexpr Milliseconds kAnswer{500};
constexpr Milliseconds kEnd{20};

}  // namespace

ControlFile::ControlFile(const std::string& path) : path_(path) {
  const int fd = open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
  if (fd < 0 || ftruncate(fd, sizeof(Control)) != 0) throw std::runtime_error("no control page " + path);
  void* mapped = mmap(nullptr, sizeof(Control), PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0);
  close(fd);
  if (mapped == MAP_FAILED) throw std::runtime_error("no control page " + path);
  control_ = static_cast<Control*>(mapped);
}

ControlFile::~ControlFile() {
  munmap(control_, sizeof(Control));
}

Stage::Stage(const Programs& programs, const std::string& dir, const std::string& data_dir, bool tls)
    : programs_(programs), dir_(dir), data_dir_(data_dir), api_("unix:" + dir + "/s.sock") {
  controls_[0] = std::make_unique<ControlFile>(path("server.control"));
  for (std::size_t i = 0; i < kWorkers; ++i) {
    controls_[i + 1] = std::make_unique<ControlFile>(path("worker" + std::to_string(i) + ".control"));
  }
  if (tls) {
    authority_ = std::make_unique<tests::TestAuthority>(dir_, "authority");
    authority_->sign("server");
  }
  renew_token(kClientOwner);
  renew_token(kWorkerOwner);
  proxy_ = std::make_unique<Proxy>([this] { return port(); });
  proxied_ = std::make_unique<Api>("127.0.0.1:" + std::to_string(proxy_->port()), access_of(kClientOwner));
}

std::string Stage::token_command(std::vector<std::string> arguments) const {
  const std::string out = path("token.out"), err = path("token.err");
  for (const std::string& file : {out, err}) tests::write_file(file, "");
  using std::filesystem::perms;
  std::filesystem::permissions(out, perms::owner_read | perms::owner_write);  // a token goes to no other file
  arguments.insert(arguments.begin(), {programs_.server, "token"});
  arguments.insert(arguments.end(), {"--data-dir", data_dir_, "--json"});
  if (run({std::move(arguments), out, err, {}}, kPatience) != 0) {
    throw std::runtime_error("affskel-server token: " + tests::read_file(err));
  }
  return tests::read_file(out);
}

void Stage::renew_token(const std::string& owner) {
  const std::string role = owner == kWorkerOwner ? "worker" : "user";
  const auto made = nlohmann::json::parse(token_command({"add", "--owner", owner, "--role", role}));
  token_ids_[owner] = std::to_string(made.at("id").get<int>());
  // In one step: a reader meanwhile finds the one or the other.
  const std::string file = access_of(owner).token_file;
  tests::write_file(file + ".new", made.at("token").get<std::string>() + "\n");
  std::filesystem::rename(file + ".new", file);
}

void Stage::revoke_token(const std::string& owner) const {
  token_command({"revoke", token_ids_.at(owner)});
}

wire::AccessFiles Stage::access_of(const std::string& owner) const {
  wire::AccessFiles files;
  files.token_file = path(owner + ".token");
  if (authority_ != nullptr) files.tls_ca = authority_->file();
  return files;
}

Process Stage::start(std::vector<std::string> arguments, const std::string& log, std::size_t control) const {
  Command command{std::move(arguments), path(log), path(log), {}};
  command.environment = {"LD_PRELOAD=" + programs_.preload,
                         "AFFSKEL_CHAOS_CONTROL=" + controls_[control]->path()};
  return Process(command);
}

void Stage::start_server() {
  std::vector<std::string> words = {programs_.server,
                                    "--data-dir",
                                    data_dir_,
                                    "--listen",
                                    address(),
                                    "--listen",
                                    "127.0.0.1:0",
                                    "--lease-ms",
                                    std::to_string(kLease.count()),
                                    "--report-interval-ms",
                                    "50"};
  if (authority_ != nullptr) {
    words.insert(words.end(),
                 {"--tls-cert", authority_->certificate("server"), "--tls-key", authority_->key("server")});
  }
  server_ = start(std::move(words), "server.log", 0);
}

void Stage::start_worker(std::size_t which) {
  std::vector<std::string> words = {programs_.worker, "--patience", "600", "--server"};
  if (which == 0) {
    const wire::AccessFiles files = access_of(kWorkerOwner);
    words.insert(words.end(),
                 {"127.0.0.1:" + std::to_string(proxy_->port()), "--token-file", files.token_file});
    if (!files.tls_ca.empty()) words.insert(words.end(), {"--tls-ca", files.tls_ca});
  } else {
    words.push_back(address());
  }
  workers_.at(which) = start(std::move(words), "worker" + std::to_string(which) + ".log", which + 1);
}

void Stage::start_workers() {
  for (std::size_t i = 0; i < kWorkers; ++i) start_worker(i);
}

void Stage::wait_for_server() {
  const Clock::time_point give_up = Clock::now() + kPatience;
  v1::ServerInfo info;
  while (!api_.info(info, kAnswer).ok()) {
    if (Process::one_ends({&server_, 1}, kEnd)) return;
    if (Clock::now() > give_up) throw Hang("the server does not answer");
  }
}

void Stage::wait_for_workers() {
  const Clock::time_point give_up = Clock::now() + kPatience;
  for (;;) {
    v1::ServerInfo info;
    static_cast<void>(api_.info(info, Milliseconds(5000)));
    const auto heard = std::count_if(info.workers().begin(), info.workers().end(), [&](const auto& known) {
      return !known.silent() && std::any_of(workers_.begin(), workers_.end(), [&](const Process& worker) {
        return static_cast<std::uint32_t>(worker.pid()) == known.pid();
      });
    });
    if (heard == kWorkers) return;
    // The caller starts again what has ended, and calls again.
    if (!server_.alive() || Process::one_ends(workers_, kEnd)) return;
    if (Clock::now() > give_up) throw Hang("a worker is not heard from: " + info.ShortDebugString());
  }
}

void Stage::calm() {
  for (const auto& control : controls_) {
    (**control).trouble = kNoTrouble;
    (**control).clock_shift_ns = 0;
    (**control).bites = 0;
  }
  proxy_->set({});
}

std::vector<std::string> Stage::restart_dead() {
  std::vector<std::string> dead;
  const auto note = [&](Process& process, const std::string& name) {
    if (process.alive()) return false;
    const auto code = process.wait(Milliseconds(0));
    dead.push_back(name + " ended with " + (code ? std::to_string(*code) : "?"));
    return true;
  };
  if (note(server_, "server")) start_server();
  for (std::size_t i = 0; i < kWorkers; ++i) {
    if (note(workers_[i], "worker " + std::to_string(i))) start_worker(i);
  }
  return dead;
}

void Stage::start_over() {
  calm();
  server_.kill_hard();
  for (Process& worker : workers_) worker.kill_hard();
  proxy_->end_all(Proxy::End::kReset);
  start_server();
  start_workers();
}

int Stage::port() const {
  const auto published = nlohmann::json::parse(tests::read_file(data_dir_ + "/server.json"), nullptr, false);
  if (!published.is_object()) return 0;
  for (const auto& address : published.value("addresses", std::vector<std::string>())) {
    if (address.rfind("127.0.0.1:", 0) == 0) return std::stoi(address.substr(10));
  }
  return 0;
}

std::string Stage::check(const std::string& data_dir) const {
  const std::string log = path("check.log");
  tests::write_file(log, "");
  const auto code = run({{programs_.server, "check", "--data-dir", data_dir}, "", log, {}}, kPatience);
  if (code == 0) return "";
  return "check ended with " + (code ? std::to_string(*code) : "nothing, in time") + ": " +
         tests::read_file(log);
}

}  // namespace affskel::chaos
