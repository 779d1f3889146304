#include "client/job_text.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <ctime>

#include "client/console.h"
#include "client/exporters/numbers.h"
#include "client/job_json.h"
#include "client/skeleton_text.h"
#include "core/base/number_text.h"

namespace affskel::client {
namespace {

constexpr std::size_t kKeyWidth = 22;
constexpr std::size_t kShortId = 12;

std::string or_unknown(const google::protobuf::EnumValueDescriptor* value) {
  const std::string word = value == nullptr ? "" : enum_word(*value);
  return word.empty() ? "unknown" : word;
}

std::string triple(const google::protobuf::RepeatedField<double>& values) {
  std::string text;
  for (const double value : values) text += (text.empty() ? "" : " ") + shortest(value);
  return text;
}

// By columns, as the message holds it.
bool is_identity(const google::protobuf::RepeatedField<double>& frame) {
  for (int i = 0; i < 9; ++i) {
    if (frame[i] != (i % 4 == 0 ? 1 : 0)) return false;
  }
  return true;
}

std::string frame_text(const google::protobuf::RepeatedField<double>& frame) {
  std::string text;
  for (int i = 0; i < 9; ++i) text += (i == 0 ? "" : i % 3 == 0 ? ", " : " ") + shortest(frame[i]);
  return text;
}

std::string prepared_details(const v1::PreparedSummary& p) {
  std::string text;
  text += key_line("points", std::to_string(p.points()));
  text += key_line("spacing", shortest(p.spacing()));
  text += key_line("v0", shortest(p.volume()));
  text += key_line("triangles", std::to_string(p.triangles()));
  text += key_line("vertices", std::to_string(p.vertices()));
  text += key_line("solids", std::to_string(p.solids()));
  text += key_line("surfaces", std::to_string(p.components()));
  text += key_line("cavities", std::to_string(p.cavities()));
  text += key_line("genus", std::to_string(p.genus()));
  if (p.frame_size() == 9 && !is_identity(p.frame())) {
    text += key_line("frame_vectors", frame_text(p.frame()));
  }
  text += key_line("bbox_min", triple(p.bbox_min()));
  text += key_line("bbox_max", triple(p.bbox_max()));
  for (const v1::MeshNote& note : p.notes()) {
    text += key_line(note.severity(), note.code() + ": " + note.message());
  }
  return text;
}

std::string asked_sampling(const v1::Sampling& s) {
  return s.density_case() == v1::Sampling::kSpacing ? "spacing " + shortest(s.spacing())
                                                    : "about " + core::counted(s.target_points(), "point");
}

std::string counters_details(const v1::JobCounters& c) {
  std::string text;
  text += key_line("directions_reported", std::to_string(c.directions_reported()));
  text += key_line("directions_repeated", std::to_string(c.directions_repeated()));
  text += key_line("reports", std::to_string(c.reports()));
  text += key_line("leases_granted", std::to_string(c.leases_granted()));
  text += key_line("leases_lost", std::to_string(c.leases_lost()));
  text += key_line("longest_report_gap", duration_text(std::chrono::milliseconds(c.longest_report_gap_ms())));
  if (c.directions_lost_estimate() > 0) {
    text += key_line("directions_lost", "about " + rounded(c.directions_lost_estimate(), 3));
  }
  return text;
}

std::string progress_text(const v1::Job& job) {
  if (job.directions_total() == 0) return "-";
  return std::to_string(job.directions_done()) + "/" + std::to_string(job.directions_total());
}

std::string age_text(std::uint64_t then_ms, std::uint64_t now_ms) {
  return duration_text(std::chrono::milliseconds(now_ms > then_ms ? now_ms - then_ms : 0));
}

// Columns in bytes; names with multi-byte characters stand last, where alignment does not matter.
std::string aligned(const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> widths;
  for (const auto& row : rows) {
    widths.resize(std::max(widths.size(), row.size()));
    for (std::size_t c = 0; c < row.size(); ++c) widths[c] = std::max(widths[c], row[c].size());
  }
  std::string text;
  for (const auto& row : rows) {
    for (std::size_t c = 0; c < row.size(); ++c) {
      text += row[c];
      if (c + 1 < row.size()) text.append(widths[c] - row[c].size() + 2, ' ');
    }
    text.push_back('\n');
  }
  return text;
}

}  // namespace

std::string frame_word(v1::Frame frame) {
  return frame == v1::FRAME_UNSPECIFIED ? "axis"
                                        : or_unknown(v1::Frame_descriptor()->FindValueByNumber(frame));
}

std::string state_word(v1::JobState state) {
  return or_unknown(v1::JobState_descriptor()->FindValueByNumber(state));
}

std::string stage_word(v1::JobStage stage) {
  return or_unknown(v1::JobStage_descriptor()->FindValueByNumber(stage));
}

std::string key_line(const std::string& key, const std::string& value) {
  const std::size_t pad = key.size() + 1 < kKeyWidth ? kKeyWidth - key.size() - 1 : 1;
  std::string safe = printable(value);
  std::replace(safe.begin(), safe.end(), '\n', ' ');
  return key + ":" + std::string(pad, ' ') + safe + "\n";
}

std::string job_details(const v1::Job& job) {
  std::string text;
  text += key_line("job", job.id());
  text += key_line("name", job.name());
  text += key_line("owner", job.owner());
  text += key_line("state", state_word(job.state()));
  text += key_line("stage", stage_word(job.stage()));
  if (job.state() == v1::JOB_STATE_FAILED) text += key_line("reason", failure_text(job.error()));
  if (!job.waiting_reason().empty()) text += key_line("reason", job.waiting_reason());
  if (job.cancel_requested()) text += key_line("cancel_requested", "yes");
  text += key_line("directions", progress_text(job));
  if (job.state() == v1::JOB_STATE_DONE) {
    text += key_line("skeleton_points", std::to_string(job.skeleton_points()));
    for (const auto& [key, value] : quality_lines(job.quality())) {
      if (job.has_quality() && key != "points") text += key_line("skeleton_" + key, value);
    }
  }
  if (job.has_prepared()) text += prepared_details(job.prepared());
  text += key_line("asked_sampling", asked_sampling(job.params().sampling()));
  text += key_line("asked_directions",
                   job.params().directions().empty() ? "triangles" : job.params().directions());
  if (frame_word(job.params().frame()) != "axis") {
    text += key_line("asked_frame", frame_word(job.params().frame()));
  }
  text += key_line("asked_skeleton", skeleton_params_text(job.skeleton()));
  text += key_line("repair", job.params().repair() ? "auto" : "none");
  text += key_line("priority", std::to_string(job.priority()));
  text += key_line("mesh_bytes", std::to_string(job.mesh_bytes()));
  text += key_line("mesh_sha256", job.mesh_sha256());
  text += key_line("created", utc_time(job.created_ms()));
  text += key_line("started", utc_time(job.started_ms()));
  text += key_line("finished", utc_time(job.finished_ms()));
  if (job.started_ms() > 0 && job.finished_ms() >= job.started_ms()) {
    text += key_line("took", age_text(job.started_ms(), job.finished_ms()));
  }
  return text + counters_details(job.counters());
}

std::string job_table(const std::vector<v1::Job>& jobs, std::uint64_t now_ms) {
  std::vector<std::vector<std::string>> rows = {
      {"JOB", "STATE", "STAGE", "DIRECTIONS", "POINTS", "SKELETON", "AGE", "OWNER", "NAME"}};
  for (const v1::Job& job : jobs) {
    rows.push_back({printable(job.id().substr(0, kShortId)), state_word(job.state()), stage_word(job.stage()),
                    progress_text(job), job.has_prepared() ? std::to_string(job.prepared().points()) : "-",
                    job.state() == v1::JOB_STATE_DONE ? std::to_string(job.skeleton_points()) : "-",
                    age_text(job.created_ms(), now_ms), printable(job.owner()), printable(job.name())});
    for (std::string& cell : rows.back()) std::replace(cell.begin(), cell.end(), '\n', ' ');
  }
  return aligned(rows);
}

std::string server_details(const v1::ServerInfo& info, std::uint64_t now_ms) {
  std::string text;
  text += key_line("version", info.version());
  text += key_line("pid", std::to_string(info.pid()));
  text += key_line("started", utc_time(info.started_ms()));
  text += key_line("up", age_text(info.started_ms(), now_ms));
  text += key_line("data_dir", info.data_dir());
  text += key_line("schema_version", std::to_string(info.schema_version()));
  text += key_line("max_mesh_bytes", std::to_string(info.max_mesh_bytes()));
  text += key_line("jobs_queued", std::to_string(info.jobs_queued()));
  text += key_line("jobs_running", std::to_string(info.jobs_running()));
  text += key_line("jobs_total", std::to_string(info.jobs_total()));
  const auto silent = std::count_if(info.workers().begin(), info.workers().end(),
                                    [](const v1::WorkerInfo& w) { return w.silent(); });
  text += key_line("workers", std::to_string(info.workers_size() - silent) +
                                  (silent == 0 ? "" : " and " + std::to_string(silent) + " silent"));
  for (const v1::WorkerInfo& w : info.workers()) {
    const std::string threads = core::counted(w.threads(), "thread");
    text +=
        key_line("worker", w.id().substr(0, kShortId) + " " + w.host() + ":" + std::to_string(w.pid()) +
                               ", " + threads + (w.supervised() ? ", supervised" : "") + ", core " +
                               w.core_version() + ", seen " + age_text(w.last_seen_ms(), now_ms) + " ago, " +
                               (w.silent()         ? "silent: dead, stopped or cut off"
                                : w.task().empty() ? "idle"
                                                   : w.task()));
  }
  return text;
}

std::string utc_time(std::uint64_t unix_ms) {
  if (unix_ms == 0) return "-";
  const auto seconds = static_cast<std::time_t>(unix_ms / 1000);
  std::tm parts{};
  gmtime_r(&seconds, &parts);
  std::array<char, 32> text{};
  const std::size_t length = std::strftime(text.data(), text.size(), "%Y-%m-%d %H:%M:%S", &parts);
  std::array<char, 8> fraction{};
  std::snprintf(fraction.data(), fraction.size(), ".%03uZ", static_cast<unsigned>(unix_ms % 1000));
  return std::string(text.data(), length) + fraction.data();
}

std::string duration_text(std::chrono::milliseconds duration) {
  const auto ms = static_cast<unsigned long long>(std::max<std::int64_t>(0, duration.count()));
  const unsigned long long s = ms / 1000;
  std::array<char, 48> text{};
  if (s < 10) {
    std::snprintf(text.data(), text.size(), "%llu.%llu s", s, ms % 1000 / 100);
  } else if (s < 60) {
    std::snprintf(text.data(), text.size(), "%llu s", s);
  } else if (s < 3600) {
    std::snprintf(text.data(), text.size(), "%llu min %02llu s", s / 60, s % 60);
  } else if (s < 86400) {
    std::snprintf(text.data(), text.size(), "%llu h %02llu min", s / 3600, s % 3600 / 60);
  } else {
    std::snprintf(text.data(), text.size(), "%llu d %02llu h", s / 86400, s % 86400 / 3600);
  }
  return text.data();
}

std::uint64_t unix_now_ms() {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return static_cast<std::uint64_t>(std::chrono::duration_cast<std::chrono::milliseconds>(now).count());
}

std::string failure_text(const v1::JobError& error) {
  std::string text = error.code().empty() ? "no reason was given" : error.code() + ": " + error.message();
  if (error.line() > 0) text += " (line " + std::to_string(error.line()) + " of the submitted file)";
  return text;
}

}  // namespace affskel::client
