#include "client/operations/page.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "base/coding.h"
#include "base/number_text.h"
#include "client/artifacts/skeleton_points.h"
#include "client/artifacts/solid_parts.h"
#include "client/files/read/input_file.h"
#include "client/operations/artifact_calls.h"
#include "client/operations/job_notices.h"
#include "client/operations/kept_stance.h"
#include "client/operations/marked_edges.h"
#include "client/text/words.h"
#include "core/chords/chord_sheet.h"
#include "core/shocks/shock_operator.h"
#include "wire/params.h"
#include "wire/words.h"

namespace affskel::client {
namespace {

// Beyond this a phone takes long to open the page; about 23 bytes each.
constexpr std::uint64_t kMaxPoints = 400000;
// Eroded solids: at 100,000 points their surfaces take about 600 kB each.
constexpr double kMaxLevels = 8, kMinLevels = 3, kPointsOfMost = 1e5;

// A field on its way into a page; a transfer that breaks off begins again from nothing.
class PointSink : public ArtifactSink {
 public:
  PointSink(const LatticePoints& lattice, const v1::Directions* directions,
            const std::vector<float>& divergences, double volume, ViewModel& model)
      : model_(model),
        collector_(model.grid, model.selection, divergences, volume, model.points),
        decoder_(lattice, directions, collector_) {}
  void begin(const v1::ArtifactHeader&) override { model_.points.clear(); }
  void data(std::string_view bytes) override { decoder_.data(bytes); }
  void end() override { decoder_.finish(); }

 private:
  ViewModel& model_;
  ViewPointCollector collector_;
  FieldDecoder decoder_;
};

// A server of a later version may know more operators.
core::ShockOperator shock_operator(v1::Operator which) {
  if (const auto known = core::shock_operator_named(wire::word(which))) return *known;
  throw ClientError(ExitCode::kUsage, "the job's skeleton is by operator " + std::to_string(which) +
                                          " of the protocol, which this version does not know; name another");
}

// The solid is parted by the curve of its ridge.
bool has_parts(v1::Operator which) {
  return which == v1::OPERATOR_RIDGE || which == v1::OPERATOR_CURVE;
}

// Where the slider of |H|, or of the share of a piece of the sheet, stands at first.
// @throws ClientError kUsage for an unknown operator.
double first_threshold(const v1::SkeletonParams& params, double spacing) {
  // The thresholds of `ridge` and `curve` are not what the slider sets: all pieces are shown.
  constexpr double kAnyPiece = 0.001;
  if (has_parts(params.operator_())) return kAnyPiece;
  const bool chords = params.operator_() == v1::OPERATOR_CHORDS;
  const double preset = chords ? core::ChordSheetOptions().significance
                               : core::default_threshold(shock_operator(params.operator_()), spacing);
  return params.threshold() > 0 ? params.threshold() : preset;
}

std::vector<float> fetch_divergences(Session& session, const std::string& job,
                                     const v1::SkeletonParams& params, std::uint64_t points) {
  v1::FetchArtifactRequest request = request_for(job, v1::ARTIFACT_KIND_DIVERGENCE);
  *request.mutable_skeleton() = params;
  v1::ArtifactHeader header;
  const std::string bytes = fetch_patiently(session, request, header, "divergence");
  if (bytes.size() != points * sizeof(double)) {
    throw ClientError(ExitCode::kInternal, "the server sent a divergence of another lattice");
  }
  std::vector<float> divergences(points);
  for (std::size_t p = 0; p < points; ++p) {
    divergences[p] = view_divergence(base::decode<double>(bytes.data() + p * sizeof(double)));
  }
  return divergences;
}

void fetch_view_points(Session& session, const v1::Job& job, const LatticePoints& lattice,
                       const std::vector<float>& divergences, ViewModel& model) {
  const FieldSource source = field_source(session, job);
  session.fetch(request_for(job.id(), source.kind), [&]() -> std::unique_ptr<ArtifactSink> {
    return std::make_unique<PointSink>(lattice, source.set(), divergences, job.prepared().volume(), model);
  });
}

// Of a skeleton of points.
v1::SkeletonQuality fetch_quality(Session& session, const v1::Job& job, const v1::SkeletonParams& params) {
  if (job.has_quality() && params.operator_() == job.skeleton().operator_() &&
      params.threshold() == job.skeleton().threshold()) {
    return job.quality();
  }
  v1::FetchArtifactRequest request = request_for(job.id(), v1::ARTIFACT_KIND_SKELETON);
  *request.mutable_skeleton() = params;
  v1::ArtifactHeader header;
  return parse_skeleton(fetch_patiently(session, request, header, "skeleton")).quality();
}

// The skeleton: a sheet, or the points with large |H|.
Notices fetch_skeleton(Session& session, const ViewSubject& subject, const LatticePoints& lattice,
                       ViewModel& model) {
  const std::string& job = subject.job.id();
  if (model.sheet_is_skeleton) {
    model.sheet = fetch_sheet(session, job, subject.params);
    model.quality = model.sheet.quality();
    return skeleton_notices(model.sheet, subject.job);
  }
  const auto divergences = fetch_divergences(session, job, subject.params, lattice.count());
  model.selection = select_view_points(divergences, model.threshold, kMaxPoints);
  fetch_view_points(session, subject.job, lattice, divergences, model);
  model.quality = fetch_quality(session, subject.job, subject.params);
  const auto items = std::count_if(divergences.begin(), divergences.end(),
                                   [&](float h) { return double{h} > model.threshold; });
  return skeleton_notices(static_cast<std::uint64_t>(items), model.quality, subject.job);
}

// The defects that the mesh had before its repair.
std::vector<MarkedEdge> repaired_edges(Session& session, const std::string& job) {
  const core::OffMesh source =
      parse_mesh(session.fetch_bytes(request_for(job, v1::ARTIFACT_KIND_SOURCE)), "source of job " + job);
  return marked_edges(source.mesh, find_defects(source, kMarkedOnPage));
}

ViewModel fetch_model(Session& session, const ViewSubject& subject, Notices& notices) {
  ViewModel model;
  model.job = subject.job;
  model.operator_name = operator_word(subject.params.operator_());
  model.sheet_is_skeleton = wire::gives_sheet(subject.params.operator_());
  model.threshold = first_threshold(subject.params, subject.job.prepared().spacing());
  const LatticePoints lattice(
      fetch_message<v1::Lattice>(session, subject.job.id(), v1::ARTIFACT_KIND_LATTICE, "lattice"));
  model.grid = view_grid(lattice);
  append(notices, fetch_skeleton(session, subject, lattice, model));
  if (has_parts(subject.params.operator_())) {
    v1::ArtifactHeader header;
    model.parts = fetch_solid_parts(session, subject.job.id(), 0, header);
    model.mesh = surface_of(model.parts);
  } else {
    model.mesh = fetch_mesh(session, subject.job.id());
  }
  if (subject.job.has_repair()) model.marks = repaired_edges(session, subject.job.id());
  return model;
}

}  // namespace

std::vector<double> view_levels(double highest, double wanted, std::uint64_t points) {
  std::vector<double> levels;
  const double room =
      kMaxLevels * std::cbrt(std::pow(kPointsOfMost / double(std::max<std::uint64_t>(1, points)), 2));
  const int count = static_cast<int>(std::clamp(room, kMinLevels, kMaxLevels));
  constexpr double kFirst = 0.2, kLast = 0.94;  // of the highest depth: beyond, little is taken or left
  for (int l = 0; l < count && highest > 0; ++l) {
    const double depth = kFirst + (kLast - kFirst) * l / (count - 1);
    const double share = depth * depth * depth * highest;
    const double digit = std::pow(10.0, std::floor(std::log10(share)) - 1);
    levels.push_back(std::stod(base::rounded(std::round(share / digit) * digit, 2)));
  }
  if (wanted > 0) levels.push_back(wanted);
  std::sort(levels.begin(), levels.end());
  levels.erase(std::unique(levels.begin(), levels.end()), levels.end());
  return levels;
}

Page make_page(Session& session, const std::vector<ViewSubject>& subjects, const ViewOptions& options) {
  Page page;
  ViewInput& input = page.input;
  std::uint64_t points = 0;
  for (const ViewSubject& subject : subjects) {
    input.models.push_back(fetch_model(session, subject, page.notices));
    points = std::max(points, subject.job.prepared().points());
  }
  for (const ViewModel& model : input.models) {
    const core::Stance stands = keep_stance(session, model.job, options.stance, model.mesh);
    if (&model == &input.models.front()) input.stance = stands;
  }
  const double highest = highest_share(input.models);
  input.levels = view_levels(highest, options.level, points);
  const double first = options.level > 0 ? options.level : 0.1 * highest;
  for (std::size_t l = 0; l < input.levels.size(); ++l) {
    if (std::fabs(input.levels[l] - first) < std::fabs(input.levels[input.first_level] - first))
      input.first_level = l;
  }
  input.show_level = options.level > 0;
  for (ViewModel& model : input.models) {
    for (const double level : input.levels) {
      model.eroded.push_back(fetch_eroded_surface(session, model.job.id(), level));
      if (level == options.level) append(page.notices, eroded_notices(model.eroded.back()));
    }
  }
  page.html = view_page(input);
  return page;
}

}  // namespace affskel::client
