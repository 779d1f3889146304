#include <bit>
#include <cstdint>
#include <random>
#include <utility>

#include "core/files/read/shape_parsers.h"

namespace affskel::core {
CornerSurface::CornerSurface() {
  std::random_device random;
  seed_ = std::uint64_t{random()} << 32 | random();
}

std::size_t CornerSurface::slot_of(const Vec3& corner) const {
  std::uint64_t hash = seed_;
  // + 0.0 makes 0 of -0.
  for (int c = 0; c < 3; ++c)
    hash = (std::rotl(hash, 23) ^ std::bit_cast<std::uint64_t>(corner[c] + 0.0)) * 0x9E3779B97F4A7C15U;
  return static_cast<std::size_t>(hash ^ hash >> 32) & (table_.size() - 1);
}

void CornerSurface::add(const Vec3& corner) {
  if (2 * mesh_.points.size() >= table_.size()) grow();
  std::size_t at = slot_of(corner);
  while (table_[at] != 0 && !(mesh_.points[table_[at] - 1] == corner)) at = (at + 1) & (table_.size() - 1);
  if (table_[at] == 0) {
    mesh_.points.push_back(corner);
    table_[at] = static_cast<std::uint32_t>(mesh_.points.size());
  }
  if (corners_ == 0) mesh_.triangles.emplace_back();
  mesh_.triangles.back()[corners_] = table_[at] - 1;
  corners_ = (corners_ + 1) % 3;
}

ShapeFile CornerSurface::take() {
  ShapeFile file;
  file.off.mesh = std::move(mesh_);
  file.off.polygons = file.off.mesh.triangles.size();
  return file;
}

void CornerSurface::grow() {
  table_.assign(table_.empty() ? 64 : 2 * table_.size(), 0);
  for (std::uint32_t v = 0; v < mesh_.points.size(); ++v) {
    std::size_t at = slot_of(mesh_.points[v]);
    while (table_[at] != 0) at = (at + 1) & (table_.size() - 1);
    table_[at] = v + 1;
  }
}

}  // namespace affskel::core
