// affskel_chaos: real servers and workers under faults drawn from a seed.
#include <sched.h>
#include <sys/mount.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <csignal>
#include <filesystem>
#include <iostream>

#include "reference.h"
#include "run.h"
#include "tools/files.h"
#include "tools/temporary_directory.h"

namespace affskel::chaos {
namespace {

struct Options {
  std::uint64_t seed = 1;
  std::uint64_t runs = 1;
  std::size_t faults = 0;
  std::vector<std::string> kinds;
  std::string binaries;
  Programs programs;
  std::string keep, table;
  bool list = false;
  bool tls = false;
};

void describe(CLI::App& app, Options& options) {
  app.add_option("--seed", options.seed, "Of the first run; the next ones take the next seeds")
      ->capture_default_str();
  app.add_option("--runs", options.runs, "Runs, each of a server of its own")->capture_default_str();
  app.add_option("--faults", options.faults, "Faults in a run; 0 = every kind once")->capture_default_str();
  app.add_option("--kinds", options.kinds, "Only these kinds")->delimiter(',');
  app.add_option("--binaries", options.binaries, "Directory of the three programs");
  app.add_option("--server-binary", options.programs.server, "Instead of BINARIES/affskel-server");
  app.add_option("--worker-binary", options.programs.worker, "Instead of BINARIES/affskel-worker");
  app.add_option("--client-binary", options.programs.client, "Instead of BINARIES/affskel-client");
  app.add_option("--preload", options.programs.preload, "The library that makes calls fail")
      ->check(CLI::ExistingFile);
  app.add_option("--keep", options.keep, "Keep logs and data of runs that failed here");
  app.add_option("--table", options.table, "Write the table here, too, after each run");
  app.add_flag("--tls", options.tls, "TCP connections, the proxy's among them, speak TLS");
  app.add_flag("--list", options.list, "Say what the kinds are");
}

/// So that a small disk can be mounted that no other process sees.  Before any thread is started.
bool enter_own_mounts() {
  const uid_t user = getuid();
  const gid_t group = getgid();
  if (unshare(CLONE_NEWNS) != 0) {
    if (unshare(CLONE_NEWUSER | CLONE_NEWNS) != 0) return false;
    tests::write_file("/proc/self/setgroups", "deny");
    tests::write_file("/proc/self/uid_map", "0 " + std::to_string(user) + " 1");
    tests::write_file("/proc/self/gid_map", "0 " + std::to_string(group) + " 1");
  }
  return mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) == 0;
}

/// The small disk, gone at the end of the scope.
class SmallDisk {
 public:
  explicit SmallDisk(const std::string& path) : path_(path) {
    std::filesystem::create_directories(path);
    mounted_ = mount("none", path.c_str(), "tmpfs", 0, "size=192m") == 0;
  }
  ~SmallDisk() {
    if (mounted_) umount2(path_.c_str(), MNT_DETACH);
  }
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;

 private:
  std::string path_;
  bool mounted_ = false;
};

std::vector<const Fault*> chosen(const Options& options) {
  const auto named = [&](const Fault& fault) {
    return std::find(options.kinds.begin(), options.kinds.end(), fault.name) != options.kinds.end();
  };
  std::vector<const Fault*> kinds;
  for (const Fault& fault : faults()) {
    if (options.kinds.empty() || named(fault)) kinds.push_back(&fault);
  }
  for (const Fault& fault : sabotages()) {
    if (named(fault)) kinds.push_back(&fault);
  }
  if (!options.kinds.empty() && kinds.size() != options.kinds.size()) {
    throw std::runtime_error("--kinds names one that there is not; see --list");
  }
  return kinds;
}

void keep(const std::string& dir, const std::string& where) {
  if (where.empty()) return;
  const std::filesystem::path target = std::filesystem::path(where) / std::filesystem::path(dir).filename();
  for (const auto& entry : std::filesystem::recursive_directory_iterator(dir)) {
    if (!entry.is_regular_file()) continue;  // sockets
    const std::filesystem::path copy = target / std::filesystem::relative(entry.path(), dir);
    std::filesystem::create_directories(copy.parent_path());
    std::filesystem::copy_file(entry.path(), copy, std::filesystem::copy_options::overwrite_existing);
  }
  std::cerr << "kept in " << target.string() << '\n';
}

/// One run; whether all was well.
bool run_once(const Options& options, const Catalogue& catalogue, const std::string& workshop,
              std::uint64_t seed, Tally& tally) {
  const std::vector<const Fault*> kinds = chosen(options);
  const std::size_t number = options.faults == 0 ? kinds.size() : options.faults;
  const std::string dir = workshop + "/" + std::to_string(seed);
  const SmallDisk disk(dir + "/disk");
  bool good = false;
  {
    Run run(options.programs, catalogue,
            {seed, schedule(kinds, number, seed), dir, dir + "/disk/data", options.tls});
    good = run.go(tally);
  }
  if (!good) keep(dir, options.keep);
  if (!options.table.empty()) tests::write_file(options.table, tally.table());
  std::cerr << "seed " << seed << ": " << number << " faults, " << (good ? "all well" : "FAILED")
            << std::endl;
  return good;
}

int run_all(const Options& options) {
  signal(SIGPIPE, SIG_IGN);
  if (!enter_own_mounts()) std::cerr << "no mounts of its own: a full disk is pretended\n";
  const tests::TemporaryDirectory workshop;
  Catalogue catalogue(options.programs, workshop.path());
  make_references(options.programs, workshop / "reference", catalogue);
  Tally tally;
  for (const Fault* kind : chosen(options)) tally.add(kind->name, {});
  for (std::uint64_t i = 0; i < options.runs; ++i) {
    run_once(options, catalogue, workshop.path(), options.seed + i, tally);
  }
  std::cout << tally.table();
  return tally.total().good() ? 0 : 1;
}

void find_programs(Options& options) {
  const auto find = [&](std::string& program, const char* name) {
    if (program.empty()) program = options.binaries + "/" + name;
    if (!std::filesystem::exists(program)) throw std::runtime_error("no program " + program);
  };
  find(options.programs.server, "affskel-server");
  find(options.programs.worker, "affskel-worker");
  find(options.programs.client, "affskel-client");
  if (options.programs.preload.empty()) throw std::runtime_error("--preload is required");
}

int main_of(int argc, char** argv) {
  CLI::App app("Real servers and workers under faults drawn from a seed; a table of what came of it");
  Options options;
  describe(app, options);
  CLI11_PARSE(app, argc, argv);
  if (options.list) {
    for (const Fault& fault : faults()) std::cout << fault.name << ": " << fault.what << '\n';
    return 0;
  }
  find_programs(options);
  return run_all(options);
}

}  // namespace
}  // namespace affskel::chaos

int main(int argc, char** argv) {
  try {
    return affskel::chaos::main_of(argc, argv);
  } catch (const std::exception& error) {
    std::cerr << "affskel_chaos: " << error.what() << '\n';
    return 2;
  }
}
