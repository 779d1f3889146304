#pragma once

#include <initializer_list>

#include "affskel/v1/types.pb.h"
#include "core/quality/advice.h"
#include "core/ridge/ridge_sheet.h"
#include "derive/finished_field.h"

namespace affskel::worker {

/// The ridge of a field, at any threshold, as far as it is not known.  Keeps a reference to the field.
class RidgeOfField {
 public:
  explicit RidgeOfField(const FinishedField& field);

  const core::RidgeBasis& basis() const { return *field_.known().basis; }

  /// @param threshold as in SkeletonParams: 0 for the default.
  const core::RidgeSheet& sheet(double threshold) const;

  /// Finds sheets that will be asked for, beside each other on the threads that there are.
  void find(std::initializer_list<double> thresholds) const;

  /// The vertices of a skeleton on it.
  void append_points(const core::SheetMesh& skeleton, v1::SkeletonPoints& message) const;

  /// What the report of a skeleton on this ridge tells of the lattice: its topology, and where it is too coarse for
  /// the solid, so that the skeleton lacks or adds something.
  /// @param cut whether parts of the sheet were asked to be left out: then it may be small on any lattice.
  void report_lattice(const core::RidgeSheet& sheet, v1::SkeletonQuality& message, bool cut = false) const;

  /// That lines on it leave out much of the solid, because it is flat; else nothing.
  core::Advice flat_advice(const core::SheetMesh& lines) const;

  /// That hardly any of the sheet is ridge, where there is no other advice.
  static void report_ridge(const core::RidgeSheet& sheet, double threshold, v1::SkeletonQuality& message);

 private:
  const FinishedField& field_;
};

/// The vertices of a skeleton on a ridge with all that they have.
void append_vertices(const FinishedField& field, const core::SheetMesh& skeleton, v1::TriangleMesh& message);

void append_segments(const core::SheetMesh& skeleton, v1::TriangleMesh& message);

/// The bounds that a threshold stands for.
core::RidgeBounds ridge_bounds(double threshold);

}  // namespace affskel::worker
