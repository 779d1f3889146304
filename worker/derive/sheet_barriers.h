#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
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
  bool cut = false;             ///< whether triangles with a low vertex were dropped
  std::string advice;           ///< why nothing is left, when the cut left nothing
};

/// A sheet's vertex in frame coordinates, as core::barriers() takes it.
core::SheetPlace sheet_place(const FinishedField& field, const core::Vec3& position,
                             const core::Vec3& normal_a, const core::Vec3& normal_b);

/// With the default directions, even in the lattice's frame.
std::vector<double> barriers_at(const FinishedField& field, const std::vector<core::SheetPlace>& places);

/// Drops the triangles with a vertex below the least barrier, then the points that none uses.
/// @param barrier per point of the sheet.
/// @return the indices that the points taken out had, ascending.
std::vector<std::uint32_t> drop_below(double least, const std::vector<double>& barrier, core::Mesh& sheet);

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
/// @param mesh_of gives the sheet as a mesh with the same vertices and triangles.
template <class Sheet, class MeshOf>
SheetBarriers take_barriers(const FinishedField& field, const v1::SurfaceParams& params, Sheet& sheet,
                            const MeshOf& mesh_of) {
  SheetBarriers result;
  if (!params.barrier()) return result;
  std::vector<core::SheetPlace> places;
  places.reserve(sheet.vertices.size());
  for (const auto& v : sheet.vertices)
    places.push_back(sheet_place(field, v.position, v.normal_a, v.normal_b));
  result.barrier = barriers_at(field, places);
  if (params.min_barrier() == 0 || sheet.triangles.empty()) return result;
  core::Mesh mesh = mesh_of(sheet);
  const std::vector<std::uint32_t> dropped = drop_below(params.min_barrier(), result.barrier, mesh);
  if (mesh.triangles.empty())
    result.advice = core::low_barriers_advice(sheet.triangles, result.barrier, params.min_barrier());
  erase_at(dropped, sheet.vertices);
  erase_at(dropped, result.barrier);
  sheet.triangles = std::move(mesh.triangles);
  result.cut = true;
  return result;
}

}  // namespace affskel::worker
