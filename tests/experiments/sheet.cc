#include "sheet.h"

#include "core/erosion/frame_field.h"
#include "core/infimum/piece_input.h"
#include "core/quality/sheet_topology.h"
#include "core/ridge/ridge_sheet.h"

namespace affskel::experiments {
namespace {

// A job's field as the operators take it, and the way from the lattice's frame to the mesh.
struct InFrame {
  core::FrameField field;
  core::Vec3 origin;
  core::Matrix3 frame;

  explicit InFrame(const Job& job)
      : field(core::frame_field(job.lattice, job.directions, job.values)),
        origin(core::SamplePlaces(job.solid, job.lattice).origin()),
        frame(core::frame_matrix(job.lattice)) {}

  core::Vec3 to_mesh(const core::Vec3& place) const { return origin + frame * place; }
};

// @param points each with its sample point, frame coordinates and E.
template <class Points>
Cloud cloud_of(const Points& points, const InFrame& in_frame) {
  Cloud cloud;
  for (const auto& point : points) {
    cloud.rank.push_back(point.point);
    cloud.place.push_back(in_frame.to_mesh(point.position));
    cloud.erosion.push_back(point.erosion);
  }
  return cloud;
}

}  // namespace

core::ChordSheet chord_sheet(const Job& job, const core::FrameField& field) {
  if (job.over_set) return core::chord_sheet(job.solid, job.lattice, field);
  const core::PieceInput input(job.solid);
  const core::RefinedPieces refined{input, job.saddles};
  return core::chord_sheet(job.solid, job.lattice, field, {.refined = &refined});
}

Sheet chord_sheet_of(const Job& job) {
  const InFrame in_frame(job);
  const core::ChordSheet found = chord_sheet(job, in_frame.field);
  Sheet sheet;
  sheet.points = cloud_of(found.shocks, in_frame);
  for (const core::SheetVertex& vertex : found.vertices)
    sheet.mesh.points.push_back(in_frame.to_mesh(vertex.position));
  sheet.mesh.triangles = found.triangles;
  sheet.betti = core::sheet_betti_numbers(sheet.mesh);
  return sheet;
}

Sheet ridge_sheet_of(const Job& job) {
  const InFrame in_frame(job);
  const core::RidgeBasis basis = core::ridge_basis(job.solid, job.lattice, in_frame.field);
  core::RidgeSheet found = core::ridge_sheet(job.solid, job.lattice, in_frame.field, basis);
  core::draw_out(found);
  Sheet sheet;
  sheet.points = cloud_of(found.vertices, in_frame);
  sheet.mesh = {sheet.points.place, found.triangles};
  sheet.segments = found.segments;
  for (const core::SheetVertex& vertex : found.vertices) sheet.kind.push_back(vertex.kind);
  sheet.betti = core::sheet_betti_numbers(sheet.mesh, sheet.segments);
  return sheet;
}

}  // namespace affskel::experiments
