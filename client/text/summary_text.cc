#include "client/text/summary_text.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/number_text.h"
#include "client/text/time_text.h"
#include "client/text/words.h"
#include "wire/params.h"

namespace affskel::client {
namespace {

bool is_torn(const v1::SkeletonQuality& quality) {
  return quality.components() > quality.solid_components();
}

}  // namespace

std::string file_stem(const std::string& name) {
  std::string stem = name;
  for (char& c : stem) {
    if (c == '/' || static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '_';
  }
  if (stem.empty() || stem == "." || stem == "..") return "skeleton";
  return (stem.front() == '-' ? "./" : "") + stem;
}

Notices job_warnings(const v1::Job& job) {
  Notices warnings;
  for (const v1::RepairStep& step : job.repair().steps())
    if (severity_word(step) == "warning") warnings.push_back(warning(step.code(), step.message()));
  for (const v1::MeshNote& note : job.prepared().notes()) {
    if (note.severity() == "warning") warnings.push_back(warning(note.code(), note.message()));
  }
  if (job.skeleton_points() == 0) return warnings;
  for (Notice& warning : skeleton_warnings(job.prepared(), job.quality()))
    warnings.push_back(std::move(warning));
  return warnings;
}

Notices skeleton_warnings(const v1::PreparedSummary& prepared, const v1::SkeletonQuality& quality) {
  Notices warnings;
  if (prepared.points() < kCoarseLattice) {
    warnings.push_back(warning(
        "COARSE_LATTICE", "the lattice is coarse, " + base::counted(prepared.points(), "point") +
                              " in the solid; submit again with a smaller spacing, such as " +
                              base::rounded(std::cbrt(prepared.volume() / 1e5), 2) + " for 100000 points"));
  }
  if (is_torn(quality)) {
    warnings.push_back(
        warning("TORN_SKELETON", "the skeleton is in " + base::counted(quality.components(), "piece") +
                                     ", the solid in " + std::to_string(quality.solid_components()) +
                                     "; a smaller spacing or threshold may join them"));
  }
  return warnings;
}

std::string summary_text(const v1::Job& job) {
  const std::uint64_t took = job.finished_ms() - std::min(job.started_ms(), job.finished_ms());
  std::string text = job.started_ms() > 0 ? "done in " + took_text(std::chrono::milliseconds(took)) : "done";
  if (took_field_over(job)) text += ", its field being there already";
  text += ": " + base::counted(job.prepared().points(), "point") + ", " +
          base::counted(job.directions_total(), "direction") + ", skeleton of " +
          (wire::gives_sheet(job.skeleton().operator_())
               ? base::counted(job.skeleton_points(), "vertex", "vertices")
               : base::counted(job.skeleton_points(), "point"));
  if (!job.has_quality() || job.skeleton_points() == 0) return text;
  return text + " in " + base::counted(job.quality().components(), "piece") +
         (is_torn(job.quality()) ? " (the solid: " + std::to_string(job.quality().solid_components()) + ")"
                                 : "");
}

bool took_field_over(const v1::Job& job) {
  const bool eroded = job.stage() == v1::JOB_STAGE_DERIVE || job.stage() == v1::JOB_STAGE_COMPLETE;
  return eroded && job.directions_total() > 0 && job.counters().directions_reported() == 0;
}

}  // namespace affskel::client
