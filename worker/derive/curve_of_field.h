#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include "affskel/v1/types.pb.h"
#include "core/curve/curve_graph.h"
#include "core/curve/curve_skeleton.h"
#include "derive/finished_field.h"
#include "derive/ridge_of_field.h"

namespace affskel::worker {

/// The curve skeleton of a field, at any threshold, as far as it is not known.  For one thread.  Keeps references to its
/// arguments.
class CurveOfField {
 public:
  CurveOfField(const FinishedField& field, const RidgeOfField& ridge)
      : field_(field), ridge_(ridge), sheet_(ridge.sheet(0)) {}

  /// @param threshold as in SkeletonParams: 0 for the default.
  const core::CurveSkeleton& at(double threshold) const;

  /// The same where its report is asked for next: on several threads the lines that it is compared to are found at the same
  /// time.
  const core::CurveSkeleton& for_report(double threshold) const;

  /// Whether a report compares a curve to that of the next threshold, whose lines have to be found.
  enum class Compared { kNo, kToNext };

  v1::SkeletonQuality quality_of(const core::CurveSkeleton& curve, double threshold,
                                 Compared compared = Compared::kToNext) const;

  /// As SURFACE gives it where it is compared, with quality and parts.
  v1::TriangleMesh message_of(const core::CurveSkeleton& curve, double threshold,
                              Compared compared = Compared::kToNext) const;

  /// In mesh coordinates.
  core::CurveGraph graph_of(const core::CurveSkeleton& curve) const;

 private:
  core::CurveOptions options_at(double threshold) const;
  core::SheetMesh lines_at(double threshold) const;
  core::CurveInput input() const;
  std::vector<core::Vec3> places_of(const core::CurveSkeleton& curve) const;

  const FinishedField& field_;
  const RidgeOfField& ridge_;
  const core::RidgeSheet& sheet_;                             // at its default threshold
  mutable std::unique_ptr<const core::LimbSurface> surface_;  // once asked for
  mutable std::map<double, core::SheetMesh> lines_;           // by threshold, until asked for
};

/// Per sample point: the part of the solid that it lies in, from 1.
std::vector<std::uint32_t> parts_of_points(const core::CurveSkeleton& curve, const core::CurveGraph& graph);

}  // namespace affskel::worker
