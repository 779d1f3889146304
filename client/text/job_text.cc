#include "client/text/job_text.h"

#include <algorithm>
#include <chrono>

#include "base/number_text.h"
#include "base/utf8.h"
#include "client/base/stance.h"
#include "client/text/job_progress.h"
#include "client/text/key_line.h"
#include "client/text/printable.h"
#include "client/text/skeleton_text.h"
#include "client/text/time_text.h"
#include "client/text/words.h"

namespace affskel::client {
namespace {

constexpr std::size_t kShortId = 12;
constexpr std::size_t kStateColumn = 1;  // of the table

// A word and its colour behind what is `before` it; control characters are out of both by now.
std::string coloured(const std::string& text, const char* colour) {
  return *colour == '\0' ? text : colour + text + "\033[0m";
}

const char* state_colour(v1::JobState state) {
  switch (state) {
    case v1::JOB_STATE_DONE:
      return "\033[32m";  // green
    case v1::JOB_STATE_RUNNING:
      return "\033[36m";  // cyan
    case v1::JOB_STATE_QUEUED:
    case v1::JOB_STATE_CANCELLED:
      return "\033[33m";  // yellow
    case v1::JOB_STATE_FAILED:
      return "\033[31m";  // red
    default:
      return "";
  }
}

// A line of `key: value` all in one colour.
std::string coloured_line(const std::string& key, const std::string& value, const char* colour) {
  std::string line = key_line(key, value);
  line.pop_back();
  return coloured(line, colour) + "\n";
}

// What was found in the mesh or done to it; warnings stand out.
std::string noted_line(const std::string& severity, const std::string& what, bool colour) {
  return coloured_line(severity, what, colour && severity == "warning" ? "\033[33m" : "");
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
  for (int i = 0; i < 9; ++i) text += (i == 0 ? "" : i % 3 == 0 ? ", " : " ") + base::to_text(frame[i]);
  return text;
}

std::string prepared_details(const v1::PreparedSummary& p, bool colour) {
  std::string text;
  text += key_line("points", std::to_string(p.points()));
  text += key_line("spacing", base::to_text(p.spacing()));
  text += key_line("v0", base::plain(p.volume(), base::kMeasureDigits));
  text += key_line("triangles", std::to_string(p.triangles()));
  text += key_line("vertices", std::to_string(p.vertices()));
  text += key_line("solids", std::to_string(p.solids()));
  text += key_line("surfaces", std::to_string(p.components()));
  text += key_line("cavities", std::to_string(p.cavities()));
  text += key_line("genus", std::to_string(p.genus()));
  if (p.frame_size() == 9 && !is_identity(p.frame())) {
    text += key_line("frame_vectors", frame_text(p.frame()));
  }
  double size = 0;
  for (int a = 0; a < std::min(p.bbox_min_size(), p.bbox_max_size()); ++a)
    size = std::max(size, p.bbox_max(a) - p.bbox_min(a));
  text += key_line("bbox_min", place_in_box({p.bbox_min().begin(), p.bbox_min().end()}, size));
  text += key_line("bbox_max", place_in_box({p.bbox_max().begin(), p.bbox_max().end()}, size));
  for (const v1::MeshNote& note : p.notes())
    text += noted_line(note.severity(), note.code() + ": " + note.message(), colour);
  return text;
}

std::string asked_sampling(const v1::Sampling& s) {
  return s.density_case() == v1::Sampling::kSpacing ? "spacing " + base::to_text(s.spacing())
                                                    : "about " + base::counted(s.target_points(), "point");
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
    text += key_line("directions_lost", "about " + base::rounded(c.directions_lost_estimate(), 3));
  }
  return text;
}

std::string progress_text(const v1::Job& job) {
  if (job.state() == v1::JOB_STATE_DONE && job.removed_ms() > 0) return "removed";
  if (job.directions_total() == 0) return "-";
  return std::to_string(job.directions_done()) + "/" + std::to_string(job.directions_total());
}

std::string refined_text(const v1::Job& job) {
  const JobProgress progress = progress_of(job);
  return std::to_string(progress.done) + "/" + std::to_string(progress.total) + " " + progress.unit;
}

using TableRow = std::vector<std::string>;

// In bytes, before colours; names with multi-byte characters stand last, where alignment does not matter.
std::vector<std::size_t> column_widths(const std::vector<TableRow>& rows) {
  std::vector<std::size_t> widths(rows.front().size());
  for (const TableRow& row : rows) {
    for (std::size_t c = 0; c < row.size(); ++c) widths[c] = std::max(widths[c], row[c].size());
  }
  return widths;
}

constexpr std::size_t kColumnGap = 2;  // between columns

std::size_t table_width(const std::vector<TableRow>& rows) {
  std::size_t width = 0;
  for (const std::size_t column : column_widths(rows)) width += column + kColumnGap;
  return width - kColumnGap;
}

// Leaves out what a person misses least; job, state and name stay.
void fit_table(std::vector<TableRow>& rows, std::size_t width) {
  for (const char* column : {"STAGE", "DIRECTIONS", "SKELETON", "OWNER", "POINTS", "AGE"}) {
    if (table_width(rows) <= width) return;
    const auto at = std::find(rows.front().begin(), rows.front().end(), column) - rows.front().begin();
    for (TableRow& row : rows) row.erase(row.begin() + at);
  }
  constexpr std::size_t kShortest = 8;
  const std::size_t before_name = table_width(rows) - column_widths(rows).back();
  const std::size_t room = std::max(kShortest, width - std::min(width, before_name));
  for (TableRow& row : rows) row.back() = base::truncate_utf8(row.back(), room);
}

std::string aligned(const std::vector<TableRow>& rows, const std::vector<const char*>& state_colours) {
  const std::vector<std::size_t> widths = column_widths(rows);
  std::string text;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const TableRow& row = rows[r];
    for (std::size_t c = 0; c < row.size(); ++c) {
      text += coloured(row[c], c == kStateColumn ? state_colours[r] : "");
      if (c + 1 < row.size()) text.append(widths[c] - row[c].size() + kColumnGap, ' ');
    }
    text.push_back('\n');
  }
  return text;
}

}  // namespace

std::string short_id(const v1::Job& job) {
  return job.id().substr(0, kShortId);
}

std::string percent_text(const v1::Job& job) {
  // In tenths of a percent, cut off; a number of directions or points has 32 bits at most.
  const JobProgress progress = progress_of(job);
  const std::uint64_t tenths = progress.total == 0 ? 0 : 1000 * progress.done / progress.total;
  return std::to_string(tenths / 10) + "." + std::to_string(tenths % 10) + "%";
}

namespace {

// What it is and how it stands.
std::string standing(const v1::Job& job, bool colour) {
  std::string text;
  text += key_line("job", job.id());
  text += key_line("name", job.name());
  text += key_line("owner", job.owner());
  text += coloured_line("state", state_word(job.state()), colour ? state_colour(job.state()) : "");
  text += key_line("stage", stage_word(job.stage()));
  if (job.state() == v1::JOB_STATE_FAILED) text += key_line("reason", failure_text(job.error()));
  if (!job.waiting_reason().empty()) text += key_line("reason", job.waiting_reason());
  if (job.pinned()) text += key_line("pinned", "yes");
  if (const auto stance = kept_stance(job)) text += key_line("stance", stance_text(*stance));
  if (job.removed_ms() > 0) {
    text += key_line("results_removed",
                     utc_time(job.removed_ms()) + ", by the server's retention; resume computes them again");
  }
  if (job.expires_ms() > 0) {
    text += key_line("expires",
                     utc_time(job.expires_ms()) +
                         (job.removed_ms() > 0 || !job.has_prepared() ? ", with its mesh" : ", its results") +
                         "; pin keeps it");
  }
  if (job.memory_needed() > 0) text += key_line("memory_needed", std::to_string(job.memory_needed()));
  if (job.cancel_requested()) text += key_line("cancel_requested", "yes");
  text += key_line("directions", progress_text(job));
  if (job.stage() == v1::JOB_STAGE_REFINE) text += key_line("refined", refined_text(job));
  if (job.state() == v1::JOB_STATE_RUNNING && job.directions_total() > 0)
    text += key_line("progress", percent_text(job));
  if (job.has_remaining_ms())
    text += key_line("remaining", "about " + duration_text(std::chrono::milliseconds(job.remaining_ms())));
  if (job.state() == v1::JOB_STATE_DONE) {
    text += key_line("skeleton_points", std::to_string(job.skeleton_points()));
    for (const auto& [key, value] : quality_lines(job.quality())) {
      if (job.has_quality() && key != "points") text += key_line("skeleton_" + key, value);
    }
  }
  return text;
}

std::string asked_for(const v1::Job& job) {
  std::string text = key_line("asked_sampling", asked_sampling(job.params().sampling()));
  text += key_line("asked_directions",
                   job.params().directions().empty() ? "triangles" : job.params().directions());
  if (frame_word(job.params().frame()) != "axis") {
    text += key_line("asked_frame", frame_word(job.params().frame()));
  }
  if (job.params().minimum() == v1::MINIMUM_INFIMUM) {
    text += key_line("asked_minimum", minimum_word(job.params().minimum()));
    if (job.refine_round() > 0) text += key_line("refine_rounds", std::to_string(job.refine_round()));
  }
  return text + key_line("asked_skeleton", skeleton_params_text(job.skeleton()));
}

}  // namespace

std::string job_details(const v1::Job& job, bool colour) {
  std::string text = standing(job, colour);
  if (job.has_prepared()) text += prepared_details(job.prepared(), colour);
  text += asked_for(job);
  text += key_line("repair", job.params().repair() ? "auto" : "none");
  for (const v1::RepairStep& step : job.repair().steps())
    text += noted_line(severity_word(step), step.code() + ": " + step.message(), colour);
  if (job.has_repair()) text += key_line("source_sha256", job.repair().source_sha256());
  text += key_line("priority", std::to_string(job.priority()));
  text += key_line("mesh_bytes", std::to_string(job.mesh_bytes()));
  text += key_line("mesh_sha256", job.mesh_sha256());
  text += key_line("created", utc_time(job.created_ms()));
  text += key_line("started", utc_time(job.started_ms()));
  text += key_line("finished", utc_time(job.finished_ms()));
  if (job.started_ms() > 0 && job.finished_ms() >= job.started_ms()) {
    text += key_line("took", took_text(std::chrono::milliseconds(job.finished_ms() - job.started_ms())));
  }
  return text + counters_details(job.counters());
}

std::string job_table(const std::vector<v1::Job>& jobs, std::uint64_t now_ms, bool colour, unsigned width) {
  std::vector<const char*> colours = {""};
  std::vector<TableRow> rows = {
      {"JOB", "STATE", "STAGE", "DIRECTIONS", "POINTS", "SKELETON", "AGE", "OWNER", "NAME"}};
  for (const v1::Job& job : jobs) {
    rows.push_back({printable(short_id(job)), state_word(job.state()), stage_word(job.stage()),
                    progress_text(job), job.has_prepared() ? std::to_string(job.prepared().points()) : "-",
                    job.state() == v1::JOB_STATE_DONE ? std::to_string(job.skeleton_points()) : "-",
                    age_text(job.created_ms(), now_ms), printable(job.owner()), printable(job.name())});
    colours.push_back(colour ? state_colour(job.state()) : "");
    for (std::string& cell : rows.back()) std::replace(cell.begin(), cell.end(), '\n', ' ');
  }
  if (width > 0) fit_table(rows, width);
  return aligned(rows, colours);
}

std::string failure_text(const v1::JobError& error) {
  std::string text = error.code().empty() ? "no reason was given" : error.code() + ": " + error.message();
  if (error.line() > 0) text += " (line " + std::to_string(error.line()) + " of the submitted file)";
  return text;
}

}  // namespace affskel::client
