#pragma once

#include <array>
#include <cstring>
#include <string>

#include "affskel/v1/types.pb.h"
#include "core/shapes/shapes.h"

namespace affskel::client {

/// A 3 x 2 x 4 lattice with a spacing of 1/3 (not exact in binary), five points in three runs; the plane i =
/// 1 is empty.
inline v1::Lattice sample_lattice() {
  v1::Lattice lattice;
  for (const double v : {0.1, -2.0, 1e6}) lattice.add_origin(v);
  for (const double v : {1.0 / 3, 0.0, 0.0, 0.0, 1.0 / 3, 0.0, 0.0, 0.0, 1.0 / 3}) lattice.add_axes(v);
  for (const unsigned d : {3u, 2u, 4u}) lattice.add_dims(d);
  const auto run = [&](std::uint64_t start, std::uint32_t length) {
    lattice.add_run_start(start);
    lattice.add_run_length(length);
  };
  run(1, 2);   // (0,0,1) (0,0,2)
  run(7, 1);   // (0,1,3)
  run(20, 2);  // (2,1,0) (2,1,1)
  return lattice;
}

/// A lattice of several slabs and chunks of an image, every third line inside, with an empty slab in between.
inline v1::Lattice lattice_of_slabs() {
  v1::Lattice lattice;
  for (const double v : {0.0, 0.0, 0.0}) lattice.add_origin(v);
  for (const double v : {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0}) lattice.add_axes(v);
  const std::array<std::uint32_t, 3> dims = {35, 40, 33};
  for (const unsigned d : dims) lattice.add_dims(d);
  for (std::uint32_t i = 0; i < dims[0]; ++i) {
    if (i >= 8 && i < 16) continue;
    for (std::uint32_t j = i % 3; j < dims[1]; j += 3) {
      lattice.add_run_start((std::uint64_t{i} * dims[1] + j) * dims[2] + j % 5);
      lattice.add_run_length(dims[2] - j % 7 - j % 5);
    }
  }
  return lattice;
}

/// Two directions.
inline v1::Directions sample_directions() {
  v1::Directions directions;
  for (const double v : {1.0, 0.0, 0.0, 0.6, 0.0, -0.8}) directions.add_xyz(v);
  return directions;
}

inline constexpr double kSampleErosion[] = {0.1, 1.0 / 3, 2e-300, 123456789.123456789, 5};
inline constexpr std::uint32_t kSampleDirection[] = {0, 1, 1, 0, 1};

/// The five records of a FIELD artefact.
inline std::string sample_field() {
  std::string bytes;
  for (std::size_t p = 0; p < 5; ++p) {
    const double area = 7.0;
    bytes.append(reinterpret_cast<const char*>(&kSampleErosion[p]), 8);
    bytes.append(reinterpret_cast<const char*>(&area), 8);
    bytes.append(reinterpret_cast<const char*>(&kSampleDirection[p]), 4);
  }
  return bytes;
}

/// The five values of a DIVERGENCE artefact.
inline std::string sample_divergence() {
  std::string bytes;
  for (const double value : {0.0, -7.25, 1.0 / 3, 2.0, 9.1}) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  return bytes;
}

/// Two skeleton points: ranks 1 and 4 of the sample lattice.
inline v1::SkeletonPoints sample_skeleton() {
  v1::SkeletonPoints s;
  for (const unsigned p : {1u, 4u}) s.add_point(p);
  for (const double v :
       {0.1, -2.0, 1000000.6666666666, 0.76666666666666661, -1.6666666666666667, 1000000.3333333334}) {
    s.add_xyz(v);
  }
  for (const double v : {1.0 / 3, 5.0}) s.add_erosion(v);
  for (const double v : {0.6, 0.0, -0.8, 0.6, 0.0, -0.8}) s.add_normal(v);
  for (const unsigned d : {1u, 1u}) s.add_direction(d);
  for (const double v : {-7.25, 9.1}) s.add_divergence(v);
  return s;
}

/// A sheet of one triangle.
inline v1::TriangleMesh sample_sheet() {
  v1::TriangleMesh sheet;
  for (const double v : {0., 0., 1000., 2000., 0., 1000., 0., 2000., 1000.}) sheet.add_xyz(v);
  for (const unsigned c : {0u, 1u, 2u}) sheet.add_corners(c);
  for (const double v : {3., 4., 5.}) sheet.add_erosion(v);
  for (const double v : {0.5, 0.6, 0.7}) sheet.add_strength(v);
  return sheet;
}

/// A cube of 2000 with a fork as its curve: a thick line of 4 along x, from its end thin ones of 3 and 5.  Five sample
/// points in three parts; twelve triangles, four in each.
inline v1::SolidParts sample_parts() {
  v1::SolidParts solid;
  v1::TriangleMesh& curve = *solid.mutable_curve();
  for (const double c : {0., 0., 0., 4., 0., 0., 4., 3., 0., 7., -4., 0.}) curve.add_xyz(c);
  for (const std::uint32_t v : {0U, 1U, 1U, 2U, 1U, 3U}) curve.add_segments(v);
  for (const double e : {1., 9., 2., 3.}) curve.add_erosion(e);
  for (const double s : {1., 1., 1., 1.}) curve.add_strength(s);
  for (const double a : {12., 12., 3., 3.}) curve.add_area(a);
  for (const double d : {1., 2., 1., 1.}) curve.add_distance(d);
  for (const double s : {0.4, 0.3, 0.1, 0.2}) curve.add_share(s);
  for (const double s : {0.2, 0.45, 0.05, 0.1}) curve.add_beyond(s);
  for (const std::uint32_t p : {1U, 1U, 3U, 2U}) curve.add_part(p);
  v1::SkeletonQuality& quality = *curve.mutable_quality();
  quality.set_points(4);
  quality.set_components(1);
  quality.set_solid_components(1);
  quality.set_branches(3);
  quality.set_ends(3);
  const auto add = [&](double share, double length, std::array<double, 3> to, double angle) {
    v1::SolidPart& part = *solid.add_parts();
    part.set_kind(v1::PART_KIND_LIMB);
    for (const double c : {4., 0., 0.}) part.add_from(c);
    for (const double c : to) part.add_to(c);
    part.set_length(length);
    part.set_straight_length(length);
    part.set_volume(8e9 * share);
    part.set_volume_share(share);
    part.set_surface_area(8e6);
    part.set_mean_radius(2);
    part.set_least_radius(1);
    part.set_greatest_radius(3);
    if (angle > 0) part.set_angle(angle);
    if (angle > 0) part.set_angle_to(1);
    part.add_vertices(1);
  };
  add(0.7, 4, {0, 0, 0}, 0);
  add(0.2, 5, {7, -4, 0}, 127);
  add(0.1, 3, {4, 3, 0}, 90);
  for (const std::uint32_t p : {1U, 1U, 2U, 3U, 1U}) solid.add_point_part(p);
  v1::TriangleMesh& surface = *solid.mutable_surface();
  const core::Mesh cube = core::make_box(2000, 2000, 2000);
  for (const core::Vec3& point : cube.points)
    for (int c = 0; c < 3; ++c) surface.add_xyz(point[c]);
  for (std::uint32_t t = 0; t < cube.triangles.size(); ++t) {
    for (const std::uint32_t v : cube.triangles[t]) surface.add_corners(v);
    solid.add_triangle_part(1 + t / 4);
    solid.add_thickness(100 + t);
  }
  solid.set_surface_area(2.4e7);
  solid.set_sheet_area(7);
  solid.set_greatest_erosion(9);
  for (const double c : {4., 0., 0.}) solid.add_greatest_place(c);
  return solid;
}

}  // namespace affskel::client
