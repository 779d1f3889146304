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
// affskel_made_up_page thinned N FILE: of 31^3 sample points, none of them of the skeleton, one in N is left.
#include <algorithm>
#include <cstdint>
#include <exception>
#include <iostream>
#include <string>
#include <vector>

#include "base/atomic_file.h"
#include "client/view/page.h"
#include "core/shapes/shapes.h"

namespace {

using affskel::client::ViewInput;
using affskel::client::ViewPoint;
using affskel::client::ViewPointCollector;

constexpr double kEdge = 4, kVolume = kEdge * kEdge * kEdge;
constexpr double kHighestShare = 0.125;
constexpr unsigned kSquares = 8;

// A lattice of so many steps along an edge.
ViewInput cube(unsigned steps) {
  ViewInput input;
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

ViewInput sheet_page() {
  ViewInput input = cube(kSquares);
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
ViewInput curve_page() {
  ViewInput input = sheet_page();
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
    input.sheet.add_segments(last);
    last = static_cast<unsigned>(input.sheet.xyz_size() / 3 - 1);
    input.sheet.add_segments(last);
  }
  return input;
}

ViewInput stretched_page() {
  ViewInput input = cube(32);
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

ViewInput thinned_page(unsigned thinning) {
  constexpr unsigned kSteps = 32;
  ViewInput input = cube(kSteps);
  input.job.set_name("thinned");
  input.selection.thinning = thinning;
  const std::vector<float> divergences((kSteps - 1) * (kSteps - 1) * (kSteps - 1), 0.0f);
  input.job.mutable_prepared()->set_points(divergences.size());
  ViewPointCollector collector(input.grid, input.selection, divergences, kVolume, input.points);
  affskel::client::FieldPoint point;
  point.normal = {0, 0, 1};
  for (point.i = 1; point.i < kSteps; ++point.i) {
    for (point.j = 1; point.j < kSteps; ++point.j) {
      for (point.k = 1; point.k < kSteps; ++point.k) {
        point.erosion = kVolume * kHighestShare * std::min({point.i, point.j, point.k}) / kSteps;
        collector.put(point);
      }
    }
  }
  collector.finish();
  return input;
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  const std::string kind = arguments.size() == 2 || arguments.size() == 3 ? arguments[0] : "";
  const bool known = kind == "thinned" ? arguments.size() == 3
                                       : arguments.size() == 2 &&
                                             (kind == "sheet" || kind == "curve" || kind == "stretched");
  if (!known) {
    std::cerr << "usage: affskel_made_up_page sheet FILE | curve FILE | stretched FILE | thinned N FILE\n";
    return 2;
  }
  try {
    const ViewInput input = kind == "sheet"   ? sheet_page()
                            : kind == "curve" ? curve_page()
                            : kind == "stretched"
                                ? stretched_page()
                                : thinned_page(static_cast<unsigned>(std::stoul(arguments[1])));
    affskel::base::AtomicFile file(arguments.back());
    file.write(affskel::client::view_page(input));
    file.commit();
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
}
