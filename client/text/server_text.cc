#include "client/text/server_text.h"

#include <algorithm>

#include "base/number_text.h"
#include "client/text/key_line.h"
#include "client/text/time_text.h"

namespace affskel::client {
namespace {

constexpr std::size_t kShortWorkerId = 12;

/// Told to admins alone.
std::string place_of(const v1::WorkerInfo& worker) {
  return worker.host().empty() ? "somewhere" : worker.host() + ":" + std::to_string(worker.pid());
}

}  // namespace

std::string server_details(const v1::ServerInfo& info, std::uint64_t now_ms) {
  std::string text;
  text += key_line("version", info.version());
  if (info.pid() > 0) text += key_line("pid", std::to_string(info.pid()));
  text += key_line("started", utc_time(info.started_ms()));
  text += key_line("up", age_text(info.started_ms(), now_ms));
  if (!info.data_dir().empty()) text += key_line("data_dir", info.data_dir());
  text += key_line("schema_version", std::to_string(info.schema_version()));
  text += key_line("max_mesh_bytes", std::to_string(info.max_mesh_bytes()));
  text += key_line("jobs_queued", std::to_string(info.jobs_queued()));
  text += key_line("jobs_running", std::to_string(info.jobs_running()));
  text += key_line("jobs_total", std::to_string(info.jobs_total()));
  if (info.database_bytes() > 0) text += key_line("database_bytes", std::to_string(info.database_bytes()));
  if (info.has_disk_free_bytes()) text += key_line("disk_free_bytes", std::to_string(info.disk_free_bytes()));
  const auto silent = std::count_if(info.workers().begin(), info.workers().end(),
                                    [](const v1::WorkerInfo& w) { return w.silent(); });
  text += key_line("workers", std::to_string(info.workers_size() - silent) +
                                  (silent == 0 ? "" : " and " + std::to_string(silent) + " silent"));
  for (const v1::WorkerInfo& w : info.workers()) {
    const std::string threads = base::counted(w.threads(), "thread");
    text +=
        key_line("worker", w.id().substr(0, kShortWorkerId) + " " + place_of(w) + ", " + threads +
                               (w.memory() > 0 ? ", " + std::to_string(w.memory() / 1000000) + " MB" : "") +
                               (w.supervised() ? ", supervised" : "") + ", core " + w.core_version() +
                               ", seen " + age_text(w.last_seen_ms(), now_ms) + " ago, " +
                               (w.silent()         ? "silent: dead, stopped or cut off"
                                : w.task().empty() ? "idle"
                                                   : w.task()));
  }
  return text;
}

}  // namespace affskel::client
