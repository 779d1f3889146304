// Writes pages of a cube of edge 4, made up so that a test knows every number on them.
//
// affskel_made_up_page sheet FILE: the skeleton is a sheet of `chords`, level, 8 x 8 squares through the
// middle, cut into three pieces: from left to right one column of strength 0.5, five of 0.5 and two of 1. The
// colour of E goes evenly from left to right.
//
// affskel_made_up_page curve FILE: the first column of that sheet, and from its last corner a curve of eight
// segments along x.
//
// affskel_made_up_page stretched FILE: the skeleton is a column of six points through the middle, of a
// lattice with steps of 1/8 along x and y and 1/2 along z.
//
// affskel_made_up_page eroded FILE: the point in the middle, and eroded solids at 2, 5 and 10 % of v0 that
// are cubes of edge 3, 2 and 1 about it.
//
// affskel_made_up_page two FILE: that page's cube beside one of half the edge with the first strip of the
// sheet.
//
// affskel_made_up_page many FILE: 47^3 points, all of them of the skeleton.
#include <cstdint>
#include <exception>
#include <functional>
#include <iostream>
#include <map>
#include <string>
#include <vector>

#include "base/atomic_file.h"
#include "client/view/page.h"
#include "core/shapes/shapes.h"

namespace {

using affskel::client::ViewInput;
using affskel::client::ViewModel;
using affskel::client::ViewPoint;

constexpr double kEdge = 4, kVolume = kEdge * kEdge * kEdge;
constexpr double kHighestShare = 0.125;
constexpr unsigned kSquares = 8;

// A lattice of so many steps along an edge.
ViewModel cube(unsigned steps) {
  ViewModel input;
  input.job.set_id("0123456789abcdef0123456789abcdef");
  input.job.mutable_prepared()->set_volume(kVolume);
  input.job.mutable_prepared()->set_spacing(kEdge / steps);
  input.mesh = affskel::core::make_box(kEdge, kEdge, kEdge);
  input.operator_name = "zucker-hummel";
  input.threshold = 7;
  input.grid.axes = {{{kEdge / steps, 0, 0}, {0, kEdge / steps, 0}, {0, 0, kEdge / steps}}};
  input.grid.lattice_steps = {1, 1, 1};
  return input;
}

// The columns begin .. end of the sheet, with vertices of their own.
void add_strip(affskel::v1::TriangleMesh& sheet, unsigned begin, unsigned end, double strength) {
  const auto first = static_cast<unsigned>(sheet.xyz_size() / 3);
  const unsigned across = end - begin + 1;
  for (unsigned row = 0; row <= kSquares; ++row) {
    for (unsigned column = begin; column <= end; ++column) {
      const double place = double(column) / kSquares;
      for (const double c : {kEdge * place, kEdge * row / kSquares, kEdge / 2}) sheet.add_xyz(c);
      sheet.add_strength(strength);
      sheet.add_area(2.5);
      for (const double c : {1., 0., 0.}) sheet.add_normal_a(c);
      for (const double c : {0., 0., -1.}) sheet.add_normal_b(c);
      sheet.add_erosion(kVolume * kHighestShare * place * place * place);
    }
  }
  for (unsigned row = 0; row < kSquares; ++row) {
    for (unsigned column = 0; column + 1 < across; ++column) {
      const unsigned a = first + row * across + column, b = a + 1, c = a + across, d = c + 1;
      for (const unsigned v : {a, b, c, b, d, c}) sheet.add_corners(v);
    }
  }
}

ViewModel sheet_model() {
  ViewModel input = cube(kSquares);
  input.job.set_name("sheet");
  input.operator_name = "chords";
  input.sheet_is_skeleton = true;
  ViewPoint centre;
  centre.step = {kSquares / 2, kSquares / 2, kSquares / 2};
  centre.share = kHighestShare;
  centre.inward = {0, 0, 1};
  input.points = {centre};
  input.job.mutable_prepared()->set_points(1);
  add_strip(input.sheet, 0, 1, 0.5);
  add_strip(input.sheet, 1, 6, 0.5);
  add_strip(input.sheet, 6, 8, 1);
  return input;
}

// The first strip, and from its upper end a curve on the same line.
ViewModel curve_model() {
  ViewModel input = sheet_model();
  input.job.set_name("curve");
  input.operator_name = "ridge";
  input.sheet.Clear();
  add_strip(input.sheet, 0, 1, 0.5);
  constexpr unsigned kSegments = 8;
  auto last = static_cast<unsigned>(input.sheet.xyz_size() / 3 - 1);
  for (unsigned s = 1; s <= kSegments; ++s) {
    const int from = 3 * static_cast<int>(last);
    const double at[] = {input.sheet.xyz(from) + kEdge / kSquares / 2, input.sheet.xyz(from + 1),
                         input.sheet.xyz(from + 2)};
    for (const double c : at) input.sheet.add_xyz(c);
    input.sheet.add_erosion(kVolume * kHighestShare);
    input.sheet.add_strength(8);
    input.sheet.add_area(2.5);
    for (const double c : {1., 0., 0.}) input.sheet.add_normal_a(c);
    for (const double c : {0., 0., -1.}) input.sheet.add_normal_b(c);
    input.sheet.add_segments(last);
    last = static_cast<unsigned>(input.sheet.xyz_size() / 3 - 1);
    input.sheet.add_segments(last);
  }
  return input;
}

// The curve's cube in two parts: what of its surface lies below the middle, and what above, which is twice as thick.
ViewModel parts_model() {
  ViewModel input = curve_model();
  input.job.set_name("parts");
  input.mesh = affskel::core::make_box(kEdge, kEdge, kEdge, 2);
  for (const auto& [a, b, c] : input.mesh.triangles) {
    const auto& points = input.mesh.points;
    const bool upper = points[a].z + points[b].z + points[c].z > 1.5 * kEdge;
    input.parts.add_triangle_part(upper ? 2 : 1);
    input.parts.add_thickness(upper ? 1 : 0.5);
  }
  for (const double share : {0.75, 0.25}) {
    affskel::v1::SolidPart& part = *input.parts.add_parts();
    part.set_kind(share > 0.5 ? affskel::v1::PART_KIND_LINK : affskel::v1::PART_KIND_LIMB);
    part.set_volume_share(share);
    part.set_volume(share * kVolume);
    part.set_length(8 * share);
    part.set_mean_radius(share);
  }
  return input;
}

ViewModel stretched_model() {
  ViewModel input = cube(32);
  input.job.set_name("stretched");
  input.grid.axes[2] = {0, 0, kEdge / 8};
  for (std::uint16_t k = 1; k <= 6; ++k) {
    ViewPoint point;
    point.step = {16, 16, k};
    point.share = kHighestShare;
    point.divergence = 9;
    point.inward = {0, 0, 1};
    input.points.push_back(point);
  }
  input.job.mutable_prepared()->set_points(input.points.size());
  return input;
}

// A cube about the middle, as an eroded solid.
affskel::v1::TriangleMesh middle_cube(double edge) {
  affskel::v1::TriangleMesh surface;
  const affskel::core::Mesh box = affskel::core::make_box(edge, edge, edge);
  for (const affskel::core::Vec3& p : box.points) {
    for (const double c : {p.x, p.y, p.z}) surface.add_xyz(c + (kEdge - edge) / 2);
    surface.add_area(edge * edge);
  }
  for (const affskel::core::Triangle& t : box.triangles) {
    for (const std::uint32_t v : t) surface.add_corners(v);
  }
  surface.set_volume(edge * edge * edge);
  return surface;
}

ViewModel eroded_model() {
  ViewModel input = cube(kSquares);
  input.job.set_name("eroded");
  ViewPoint centre;
  centre.step = {kSquares / 2, kSquares / 2, kSquares / 2};
  centre.share = kHighestShare;
  centre.divergence = 9;
  centre.slope = 1.5;
  centre.inward = {0, 0, 1};
  input.points = {centre};
  input.job.mutable_prepared()->set_points(1);
  for (const double edge : {3., 2., 1.}) input.eroded.push_back(middle_cube(edge));
  input.job.mutable_prepared()->add_notes()->set_message("made up");
  input.quality.set_points(1);
  input.quality.set_components(1);
  input.quality.set_solid_components(1);
  return input;
}

ViewInput page_of(const ViewModel& model) {
  ViewInput input;
  input.models = {model};
  return input;
}

ViewInput eroded_page() {
  ViewInput input = page_of(eroded_model());
  input.levels = {0.02, 0.05, 0.1};
  input.first_level = 1;
  return input;
}

ViewInput two_page() {
  ViewInput input = eroded_page();
  ViewModel half = sheet_model();
  half.job.set_name("half");
  half.mesh = affskel::core::make_box(kEdge / 2, kEdge / 2, kEdge / 2);
  half.sheet.Clear();
  add_strip(half.sheet, 0, 1, 0.5);
  for (int level = 0; level < 3; ++level) half.eroded.push_back(middle_cube(0.5));
  input.models.push_back(half);
  return input;
}

ViewModel many_model() {
  constexpr std::uint16_t kSteps = 48;
  ViewModel input = cube(kSteps);
  input.job.set_name("many");
  for (std::uint16_t i = 1; i < kSteps; ++i) {
    for (std::uint16_t j = 1; j < kSteps; ++j) {
      for (std::uint16_t k = 1; k < kSteps; ++k) {
        ViewPoint point;
        point.step = {i, j, k};
        point.share = static_cast<float>(kHighestShare * k / kSteps);
        point.divergence = 9;
        point.inward = {0, 0, 1};
        input.points.push_back(point);
      }
    }
  }
  input.job.mutable_prepared()->set_points(input.points.size());
  return input;
}

const std::map<std::string, std::function<ViewInput()>> kPages = {
    {"sheet", [] { return page_of(sheet_model()); }},
    {"curve", [] { return page_of(curve_model()); }},
    {"parts", [] { return page_of(parts_model()); }},
    {"stretched", [] { return page_of(stretched_model()); }},
    {"eroded", eroded_page},
    {"two", two_page},
    {"many", [] { return page_of(many_model()); }}};

}  // namespace

int main(int argc, char** argv) {
  const auto page = argc == 3 ? kPages.find(argv[1]) : kPages.end();
  if (page == kPages.end()) {
    std::cerr << "usage: affskel_made_up_page sheet|curve|parts|stretched|eroded|two|many FILE\n";
    return 2;
  }
  try {
    affskel::base::AtomicFile file(argv[2]);
    file.write(affskel::client::view_page(page->second()));
    file.commit();
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
}
