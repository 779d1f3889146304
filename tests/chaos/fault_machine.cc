// The machine under a process: its disk, its memory, its clock.
#include <fcntl.h>
#include <sys/resource.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <sstream>
#include <thread>

#include "faults.h"
#include "tools/files.h"

namespace affskel::chaos {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::int64_t kHourNs = 3'600'000'000'000;
constexpr Milliseconds kMachineCall{1000};

/// Calls that need the disk, so that a fault there is met: answers of any kind are welcome.
void use_disk(Scene& scene) {
  scene.submit(scene.stage.api(), scene.catalogue.next(kTiny, scene.new_name()), kMachineCall);
  for (const auto& [id, entry] : scene.ledger.entries()) {
    if (!entry.verified) continue;
    std::string bytes;
    const v1::ArtifactKind kind = scene.pick(2) == 0 ? v1::ARTIFACT_KIND_FIELD : v1::ARTIFACT_KIND_MESH;
    static_cast<void>(scene.stage.api().fetch(artefact(id, kind), bytes, kMachineCall));
    if (scene.pick(3) == 0) break;
  }
}

/// The server's files misbehave until some calls felt it.
bool files_fail(Scene& scene, Trouble trouble) {
  Control& control = scene.stage.server_control();
  control.bites = 0;
  control.trouble = trouble;
  const auto begun = Clock::now();
  do {
    use_disk(scene);
    last_for(Milliseconds(30));
  } while (scene.stage.server().alive() &&
           Clock::now() < begun + Milliseconds(control.bites > 0 ? 400 : 3000));
  control.trouble = kNoTrouble;
  return control.bites > 0;
}

/// Takes all room that the data directory's file system has; gives it back at the end.
class Filler {
 public:
  explicit Filler(std::string path) : path_(std::move(path)) {
    fd_ = open(path_.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0600);
    grow();
  }
  ~Filler() {
    close(fd_);
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }
  Filler(const Filler&) = delete;
  Filler& operator=(const Filler&) = delete;

  /// Takes what became free meanwhile.
  void grow() {
    for (off_t step = off_t{64} << 20; step >= 4096;) {
      if (posix_fallocate(fd_, size_, step) == 0) {
        size_ += step;
      } else {
        step /= 2;
      }
    }
  }

 private:
  std::string path_;
  int fd_ = -1;
  off_t size_ = 0;
};

/// Whether filling the disk disturbs no other program: it is small, the driver's own.
bool has_own_disk(const std::string& dir) {
  struct statvfs facts {};
  return statvfs(dir.c_str(), &facts) == 0 && facts.f_blocks * facts.f_frsize < (std::uint64_t{1} << 30);
}

/// Bytes of address space that a process has.
rlim_t address_space(pid_t pid) {
  std::istringstream pages(tests::read_file("/proc/" + std::to_string(pid) + "/statm"));
  rlim_t count = 0;
  pages >> count;
  return count * static_cast<rlim_t>(sysconf(_SC_PAGESIZE));
}

/// The process may have hardly more memory than it has, while it is kept busy.
bool starve(Scene& scene, const Process& process, std::size_t spare) {
  rlimit before{};
  if (prlimit(process.pid(), RLIMIT_AS, nullptr, &before) != 0) return false;
  const rlimit tight{address_space(process.pid()) + spare, before.rlim_max};
  prlimit(process.pid(), RLIMIT_AS, &tight, nullptr);
  std::vector<Submission> submissions;
  for (int i = 0; i < 4; ++i) submissions.push_back(scene.catalogue.next(kMedium, scene.new_name()));
  in_parallel(submissions.size(),
              [&](std::size_t i) { scene.submit(scene.stage.api(), submissions[i], kMachineCall); });
  use_disk(scene);
  last_for(Milliseconds(300));
  prlimit(process.pid(), RLIMIT_AS, &before, nullptr);
  return true;
}

bool jump(Scene& scene, const std::vector<std::pair<Control*, std::int64_t>>& shifts) {
  for (const auto& [control, shift] : shifts) {
    control->bites = 0;
    control->clock_shift_ns = shift;
  }
  use_disk(scene);
  outlast_lease();
  bool felt = false;
  for (const auto& [control, shift] : shifts) {
    control->clock_shift_ns = 0;
    felt = felt || control->bites > 0;
  }
  return felt;
}

}  // namespace

bool disk_full(Scene& scene) {
  if (!has_own_disk(scene.stage.data_dir())) return files_fail(scene, kNoSpace);
  Filler filler(scene.stage.data_dir() + "/../filler");
  for (int i = 0; i < 3; ++i) {
    use_disk(scene);
    filler.grow();  // the server's reserve, too
  }
  last_for(Milliseconds(300));
  return true;
}

bool no_space(Scene& scene) {
  return files_fail(scene, kNoSpace);
}

bool write_error(Scene& scene) {
  return files_fail(scene, kWriteError);
}

bool sync_error(Scene& scene) {
  return files_fail(scene, kSyncError);
}

bool read_error(Scene& scene) {
  return files_fail(scene, kReadError);
}

bool read_only(Scene& scene) {
  return files_fail(scene, kReadOnly);
}

bool short_writes(Scene& scene) {
  return files_fail(scene, kShortWrites);
}

bool memory_server(Scene& scene) {
  return starve(scene, scene.stage.server(), scene.pick(2) * (std::size_t{1} << 20));
}

bool memory_worker(Scene& scene) {
  return starve(scene, scene.stage.worker(scene.pick(kWorkers)), 0);
}

bool clock_forward(Scene& scene) {
  return jump(scene, {{&scene.stage.server_control(), kHourNs}});
}

bool clock_back(Scene& scene) {
  return jump(scene, {{&scene.stage.server_control(), -kHourNs}});
}

bool clock_workers(Scene& scene) {
  return jump(scene, {{&scene.stage.worker_control(0), kHourNs}, {&scene.stage.worker_control(1), -kHourNs}});
}

}  // namespace affskel::chaos
