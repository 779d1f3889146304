#include "client/commands/shared/fetch_view.h"

#include <algorithm>
#include <array>
#include <memory>
#include <utility>

#include "base/coding.h"
#include "client/commands/shared/fetch_artifact.h"
#include "client/commands/shared/follow.h"
#include "client/text/words.h"
#include "core/chords/chord_pruning.h"
#include "core/ridge/ridge_rims.h"
#include "core/shocks/shock_operator.h"
#include "wire/params.h"

namespace affskel::client {
namespace {

// Beyond this a phone takes long to open the page; about 19 bytes each.
constexpr std::uint64_t kMaxPoints = 400000;

// A field on its way into a page; a transfer that breaks off begins again from nothing.
class PointSink : public ArtifactSink {
 public:
  PointSink(const LatticePoints& lattice, const v1::Directions& directions,
            const std::vector<float>& divergences, double volume, ViewInput& input)
      : input_(input),
        collector_(input.grid, input.selection, divergences, volume, input.points),
        decoder_(lattice, directions, collector_) {}
  void begin(const v1::ArtifactHeader&) override { input_.points.clear(); }
  void data(std::string_view bytes) override { decoder_.data(bytes); }
  void end() override { decoder_.finish(); }

 private:
  ViewInput& input_;
  ViewPointCollector collector_;
  FieldDecoder decoder_;
};

// The operators of H, all but `chords`.
constexpr std::array<std::pair<v1::Operator, core::ShockOperator>, 5> kShockOperators = {
    {{v1::OPERATOR_ZUCKER_HUMMEL, core::ShockOperator::kZuckerHummel},
     {v1::OPERATOR_INTERMEDIATE, core::ShockOperator::kIntermediate},
     {v1::OPERATOR_CENTRAL, core::ShockOperator::kCentral},
     {v1::OPERATOR_SOBEL, core::ShockOperator::kSobel},
     {v1::OPERATOR_FLUX, core::ShockOperator::kFlux}}};

// A server of a later version may know more operators.
core::ShockOperator shock_operator(v1::Operator which) {
  for (const auto& [known, shock_operator] : kShockOperators) {
    if (known == which) return shock_operator;
  }
  throw ClientError(ExitCode::kUsage, "the job's skeleton is by operator " + std::to_string(which) +
                                          " of the protocol, which this version does not know; name another "
                                          "with --operator");
}

// Where the slider of |H|, or of the share of a piece of the sheet, stands at first.
// @throws ClientError kUsage for an unknown operator.
double first_threshold(const v1::SkeletonParams& params, double spacing) {
  // The threshold of `ridge` is a strength, which the slider does not set.
  if (params.operator_() == v1::OPERATOR_RIDGE) return core::RidgeRimOptions().significance;
  const bool chords = params.operator_() == v1::OPERATOR_CHORDS;
  const double preset = chords ? core::ChordPruningOptions().significance
                               : core::default_threshold(shock_operator(params.operator_()), spacing);
  return params.threshold() > 0 ? params.threshold() : preset;
}

std::vector<float> fetch_divergences(Context& context, const std::string& job,
                                     const v1::SkeletonParams& params, std::uint64_t points) {
  v1::FetchArtifactRequest request = request_for(job, v1::ARTIFACT_KIND_DIVERGENCE);
  *request.mutable_skeleton() = params;
  v1::ArtifactHeader header;
  const std::string bytes = fetch_patiently(context, request, header, "divergence");
  if (bytes.size() != points * sizeof(double)) {
    throw ClientError(ExitCode::kInternal, "the server sent a divergence of another lattice");
  }
  std::vector<float> divergences(points);
  for (std::size_t p = 0; p < points; ++p) {
    divergences[p] = view_divergence(base::decode<double>(bytes.data() + p * sizeof(double)));
  }
  return divergences;
}

}  // namespace

ViewInput fetch_view(Context& context, const v1::Job& job, const v1::SkeletonParams& params) {
  ViewInput input;
  input.job = job;
  input.operator_name = operator_word(params.operator_());
  input.sheet_is_skeleton = wire::gives_sheet(params.operator_());
  input.threshold = first_threshold(params, job.prepared().spacing());
  const LatticePoints lattice(
      fetch_message<v1::Lattice>(context, job.id(), v1::ARTIFACT_KIND_LATTICE, "lattice"));
  std::vector<float> divergences;
  if (input.sheet_is_skeleton) {
    input.sheet = fetch_sheet(context, job.id(), params);
  } else {
    divergences = fetch_divergences(context, job.id(), params, lattice.count());
  }
  const auto kept = std::count_if(divergences.begin(), divergences.end(),
                                  [&](float h) { return double{h} > input.threshold; });
  warn_about_skeleton(
      context.console(),
      static_cast<std::uint64_t>(
          input.sheet_is_skeleton ? input.sheet.corners_size() / 3 + input.sheet.segments_size() / 2 : kept),
      input.sheet.quality(), job);
  input.grid = view_grid(lattice);
  input.selection = select_view_points(lattice.count(), divergences, input.threshold, kMaxPoints);
  const auto directions =
      fetch_message<v1::Directions>(context, job.id(), v1::ARTIFACT_KIND_DIRECTIONS, "direction set");
  context.session().fetch(
      request_for(job.id(), v1::ARTIFACT_KIND_FIELD), [&]() -> std::unique_ptr<ArtifactSink> {
        return std::make_unique<PointSink>(lattice, directions, divergences, job.prepared().volume(), input);
      });
  input.mesh = fetch_mesh(context, job.id());
  return input;
}

}  // namespace affskel::client
