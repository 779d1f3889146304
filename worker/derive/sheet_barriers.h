#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "affskel/v1/types.pb.h"
#include "core/barrier/barriers.h"
#include "core/mesh/mesh.h"
#include "core/quality/skeleton_advice.h"
#include "derive/finished_field.h"

namespace affskel::worker {

/// What the parameters of a surface ask for at the vertices of its sheet.
struct SheetBarriers {
  std::vector<double> barrier;  ///< per vertex that is left; empty unless asked for
  bool cut = false;             ///< whether triangles and segments with a low vertex were dropped
  core::Advice advice;          ///< why nothing is left, when the cut left nothing
};

/// A sheet's vertex in frame coordinates, as core::barriers() takes it.
core::SheetPlace sheet_place(const FinishedField& field, const core::Vec3& position,
                             const core::Vec3& normal_a, const core::Vec3& normal_b);

/// With the default directions, even in the lattice's frame.
std::vector<double> barriers_at(const FinishedField& field, const std::vector<core::SheetPlace>& places);

/// Drops the triangles and segments with a vertex below the least barrier, then numbers anew the vertices
/// that are left, those that one of the others uses.
/// @param barrier per vertex.
/// @return the indices that the vertices taken out had, ascending.
std::vector<std::uint32_t> drop_below(double least, const std::vector<double>& barrier,
                                      std::vector<core::Triangle>& triangles,
                                      std::vector<core::Segment>& segments);

/// Takes out what stands at the given places, ascending.
template <class Value>
void erase_at(const std::vector<std::uint32_t>& places, std::vector<Value>& values) {
  std::size_t kept = 0, next = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (next < places.size() && places[next] == i) {
      ++next;
      continue;
    }
    values[kept++] = values[i];
  }
  values.resize(kept);
}

/// Computes the barriers, and cuts the sheet, as the parameters ask.
/// @param segments of its curves.
template <class Sheet>
SheetBarriers take_barriers(const FinishedField& field, const v1::SurfaceParams& params, Sheet& sheet,
                            std::vector<core::Segment>& segments) {
  SheetBarriers result;
  if (!params.barrier()) return result;
  std::vector<core::SheetPlace> places;
  places.reserve(sheet.vertices.size());
  for (const core::SheetVertex& v : sheet.vertices)
    places.push_back(v.turns ? core::SheetPlace{}  // which has none
                             : sheet_place(field, v.position, v.normal_a, v.normal_b));
  result.barrier = barriers_at(field, places);
  if (params.min_barrier() == 0 || sheet.vertices.empty()) return result;
  const std::vector<core::Triangle> all = sheet.triangles;
  const std::vector<core::Segment> all_segments = segments;
  const std::vector<std::uint32_t> dropped =
      drop_below(params.min_barrier(), result.barrier, sheet.triangles, segments);
  if (sheet.triangles.empty() && segments.empty())
    result.advice = core::low_barriers_advice(all, all_segments, result.barrier, params.min_barrier());
  erase_at(dropped, sheet.vertices);
  erase_at(dropped, result.barrier);
  result.cut = true;
  return result;
}

}  // namespace affskel::worker
