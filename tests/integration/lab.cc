#include "lab.h"

#include <fcntl.h>
#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <thread>
#include <utility>

#include "tools/files.h"

namespace affskel::integration {
namespace {

// Long enough for a loaded machine; nothing waits for it when all is well.
constexpr auto kPatience = std::chrono::seconds(120);

[[noreturn]] void execute(const std::vector<std::string>& arguments, const std::string& out,
                          const std::string& err, const std::vector<std::string>& environment) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  const int in_fd = open("/dev/null", O_RDONLY);
  const int out_fd = open(out.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0600);
  const int err_fd = open(err.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0600);
  dup2(in_fd, 0);
  dup2(out_fd, 1);
  dup2(err_fd, 2);
  for (const std::string& entry : environment) putenv(const_cast<char*>(entry.c_str()));
  std::vector<char*> argv;
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  execv(argv[0], argv.data());
  _exit(127);
}

pid_t start(const std::vector<std::string>& arguments, const std::string& out, const std::string& err,
            const std::vector<std::string>& environment) {
  const pid_t pid = fork();
  if (pid < 0) throw std::runtime_error("fork failed");
  if (pid == 0) execute(arguments, out, err, environment);
  return pid;
}

int wait_for(pid_t pid) {
  int status = 0;
  while (waitpid(pid, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

bool is_final(const v1::Job& job) {
  return job.state() == v1::JOB_STATE_DONE || job.state() == v1::JOB_STATE_FAILED ||
         job.state() == v1::JOB_STATE_CANCELLED;
}

// Calls until the server answers; a connection to one that was killed fails once before it is made again.
template <class Call>
grpc::Status call_when_ready(Call call) {
  const auto give_up = std::chrono::system_clock::now() + kPatience;
  for (;;) {
    grpc::ClientContext context;
    context.set_wait_for_ready(true);
    context.set_deadline(give_up);
    const grpc::Status status = call(context);
    if (status.error_code() != grpc::StatusCode::UNAVAILABLE) return status;
  }
}

std::unique_ptr<v1::ErosionService::Stub> connect(const std::string& address) {
  grpc::ChannelArguments arguments;
  arguments.SetInt(GRPC_ARG_INITIAL_RECONNECT_BACKOFF_MS, 20);
  arguments.SetInt(GRPC_ARG_MIN_RECONNECT_BACKOFF_MS, 20);
  arguments.SetInt(GRPC_ARG_MAX_RECONNECT_BACKOFF_MS, 100);
  return v1::ErosionService::NewStub(
      grpc::CreateCustomChannel(address, grpc::InsecureChannelCredentials(), arguments));
}

}  // namespace

Process::Process(const std::vector<std::string>& arguments, const std::string& log,
                 const std::vector<std::string>& environment)
    : pid_(start(arguments, log, log, environment)) {}

Process::~Process() {
  if (pid_ > 0) kill_hard();
}

Process::Process(Process&& other) noexcept : pid_(std::exchange(other.pid_, -1)) {}

Process& Process::operator=(Process&& other) noexcept {
  if (pid_ > 0) kill_hard();
  pid_ = std::exchange(other.pid_, -1);
  return *this;
}

bool Process::running() const {
  siginfo_t state{};
  return waitid(P_PID, static_cast<id_t>(pid_), &state, WEXITED | WNOHANG | WNOWAIT) == 0 &&
         state.si_pid == 0;
}

void Process::send(int signal) const {
  kill(pid_, signal);
}

int Process::wait() {
  return wait_for(std::exchange(pid_, -1));
}

void Process::kill_hard() {
  send(SIGKILL);
  wait();
}

Lab::Lab() {
  stub_ = connect(address());
}

Lab::~Lab() {
  if (testing::Test::HasFailure()) {
    for (const char* log : {"server.log", "worker.log"}) {
      if (std::filesystem::exists(path(log))) fprintf(stderr, "---- %s\n%s", log, read(log).c_str());
    }
  }
}

std::string Lab::metrics_address() const {
  // The server answers a moment before it says where.
  for (const auto give_up = std::chrono::steady_clock::now() + kPatience;
       std::chrono::steady_clock::now() < give_up; std::this_thread::yield()) {
    const auto told = nlohmann::json::parse(read("data/server.json"), nullptr, false);
    if (told.is_object()) return told.at("metrics");
  }
  throw std::runtime_error("the server does not say where its metrics are");
}

std::string Lab::read(const std::string& name) const {
  return tests::read_file(path(name));
}

void Lab::write(const std::string& name, const std::string& bytes) const {
  tests::write_file(path(name), bytes);
}

Process Lab::server(const std::vector<std::string>& options) const {
  std::vector<std::string> arguments = {AFFSKEL_SERVER_BINARY, "--data-dir", path("data"), "--listen",
                                        address()};
  arguments.insert(arguments.end(), options.begin(), options.end());
  Process process(arguments, path("server.log"));
  wait_for_server();
  return process;
}

void Lab::wait_for_server() const {
  v1::ServerInfo info;
  const grpc::Status status = call_when_ready(
      [&](grpc::ClientContext& context) { return stub_->GetServerInfo(&context, {}, &info); });
  if (!status.ok()) throw std::runtime_error("the server does not answer: " + status.error_message());
}

namespace {

// In a mount namespace of its own, which needs no privileges where users may have theirs.
std::vector<std::string> in_own_mounts(const std::string& script) {
  return {"/usr/bin/unshare", "--user", "--map-root-user", "--mount", "/bin/sh", "-c", script, "sh"};
}

}  // namespace

bool Lab::can_mount() const {
  std::filesystem::create_directory(path("disk"));
  std::vector<std::string> arguments = in_own_mounts("mount -t tmpfs none \"$1\"");
  arguments.push_back(path("disk"));
  return run(arguments).exit_code == 0;
}

std::vector<std::string> Lab::on_small_disk(const std::string& limits,
                                            const std::vector<std::string>& command) const {
  std::filesystem::create_directory(path("disk"));
  std::vector<std::string> arguments =
      in_own_mounts("mount -t tmpfs -o \"$1\" none \"$2\" && shift 2 && exec \"$@\"");
  arguments.insert(arguments.end(), {limits, path("disk")});
  arguments.insert(arguments.end(), command.begin(), command.end());
  return arguments;
}

Process Lab::server_on_small_disk(const std::string& size, const std::vector<std::string>& options) const {
  std::vector<std::string> command = {AFFSKEL_SERVER_BINARY, "--data-dir", path("disk/data"), "--listen",
                                      address()};
  command.insert(command.end(), options.begin(), options.end());
  Process process(on_small_disk("size=" + size, command), path("server.log"));
  wait_for_server();
  return process;
}

Process Lab::worker(const std::vector<std::string>& options) const {
  std::vector<std::string> arguments = {AFFSKEL_WORKER_BINARY, "--server", address()};
  arguments.insert(arguments.end(), options.begin(), options.end());
  return Process(arguments, path("worker.log"));
}

Output Lab::client(const std::vector<std::string>& arguments) const {
  std::vector<std::string> all = {AFFSKEL_CLIENT_BINARY, "--server", address()};
  all.insert(all.end(), arguments.begin(), arguments.end());
  return run(all);
}

Output Lab::run(const std::vector<std::string>& arguments,
                const std::vector<std::string>& environment) const {
  static int number = 0;
  const std::string out = path("out" + std::to_string(++number)), err = path("err" + std::to_string(number));
  const int code = wait_for(start(arguments, out, err, environment));
  return {code, tests::read_file(out), tests::read_file(err)};
}

void Lab::make_torus(int triangles) const {
  const Output made = run({AFFSKEL_CLIENT_BINARY, "make", "torus", "--triangles", std::to_string(triangles),
                           "-o", path("m.off")});
  if (made.exit_code != 0) throw std::runtime_error("no torus: " + made.err);
}

std::string Lab::submit(const std::vector<std::string>& options) const {
  std::vector<std::string> arguments = {"submit", path("m.off")};
  arguments.insert(arguments.end(), options.begin(), options.end());
  const Output submitted = client(arguments);
  if (submitted.exit_code != 0) throw std::runtime_error("not submitted: " + submitted.err);
  return submitted.out.substr(0, submitted.out.find('\n'));
}

v1::Job Lab::job(const std::string& id) const {
  v1::GetJobRequest request;
  request.set_job(id);
  v1::Job job;
  const grpc::Status status =
      call_when_ready([&](grpc::ClientContext& context) { return stub_->GetJob(&context, request, &job); });
  if (!status.ok()) throw std::runtime_error("GetJob: " + status.error_message());
  return job;
}

v1::Giver Lab::only_giver(const std::string& id) const {
  v1::ListJobEventsRequest request;
  request.set_job(id);
  v1::ListJobEventsResponse events;
  const grpc::Status status = call_when_ready(
      [&](grpc::ClientContext& context) { return stub_->ListJobEvents(&context, request, &events); });
  if (!status.ok()) throw std::runtime_error("ListJobEvents: " + status.error_message());
  if (events.givers_size() != 1) throw std::runtime_error("not one giver: " + events.ShortDebugString());
  return events.givers(0);
}

v1::Job Lab::follow(const std::string& id, const std::function<bool(const v1::Job&)>& condition) const {
  const auto give_up = std::chrono::system_clock::now() + kPatience;
  while (std::chrono::system_clock::now() < give_up) {
    grpc::ClientContext context;
    context.set_wait_for_ready(true);
    context.set_deadline(give_up);
    v1::WatchJobRequest request;
    request.set_job(id);
    const auto reader = stub_->WatchJob(&context, request);
    v1::Job job;
    while (reader->Read(&job)) {
      if (!condition(job) && !is_final(job)) continue;
      context.TryCancel();
      reader->Finish();
      return job;
    }
    reader->Finish();  // the server went away: attach again
  }
  throw std::runtime_error("job " + id + " did not get there in time");
}

v1::Job Lab::follow_to_share(const std::string& id, double share) const {
  return follow(id, [share](const v1::Job& job) {
    return job.directions_total() > 0 &&
           static_cast<double>(job.directions_done()) >= share * static_cast<double>(job.directions_total());
  });
}

v1::Job Lab::follow_to_end(const std::string& id) const {
  return follow(id, [](const v1::Job&) { return false; });
}

}  // namespace affskel::integration
