#include "sheet.h"

#include "core/chords/chord_sheet.h"
#include "core/erosion/frame_field.h"
#include "core/quality/sheet_topology.h"
#include "core/ridge/ridge_sheet.h"

namespace affskel::experiments {

Sheet chord_sheet_of(const Job& job) {
  const core::FrameField field = core::frame_field(job.lattice, job.directions, job.values);
  const core::ChordSheet found = core::chord_sheet(job.solid, job.lattice, field);
  const core::SamplePlaces places(job.solid, job.lattice);
  const core::Matrix3 frame = core::frame_matrix(job.lattice);
  Sheet sheet;
  for (const core::ChordShock& shock : found.shocks) {
    sheet.points.rank.push_back(shock.point);
    sheet.points.place.push_back(places.origin() + frame * shock.position);
    sheet.points.erosion.push_back(shock.erosion);
  }
  for (const core::ChordSheetVertex& vertex : found.vertices) {
    sheet.mesh.points.push_back(places.origin() + frame * vertex.position);
  }
  sheet.mesh.triangles = found.triangles;
  sheet.betti = core::sheet_topology(sheet.mesh).betti;
  return sheet;
}

Sheet ridge_sheet_of(const Job& job) {
  const core::FrameField field = core::frame_field(job.lattice, job.directions, job.values);
  const core::RidgeSheet found = core::ridge_sheet(job.solid, job.lattice, field);
  const core::SamplePlaces places(job.solid, job.lattice);
  const core::Matrix3 frame = core::frame_matrix(job.lattice);
  Sheet sheet;
  for (const core::RidgeVertex& vertex : found.vertices) {
    sheet.points.rank.push_back(vertex.point);
    sheet.points.place.push_back(places.origin() + frame * vertex.position);
    sheet.points.erosion.push_back(vertex.erosion);
  }
  sheet.mesh = {sheet.points.place, found.triangles};
  sheet.segments = found.segments;
  sheet.betti = core::sheet_topology(sheet.mesh, sheet.segments).betti;
  return sheet;
}

}  // namespace affskel::experiments
