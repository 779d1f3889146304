// Writes pages of a cube of edge 4, made up so that a test knows every number on them.
//
// affskel_made_up_page sheet FILE: the skeleton is a sheet of `chords`, level, 8 x 8 squares through the
// middle; the strength of a vertex is 0.5 + 0.05 times its column, the colour of its E goes evenly from left
// to right.
//
// affskel_made_up_page thinned N FILE: of 31^3 sample points, none of them of the skeleton, one in N is left.
#include <algorithm>
#include <exception>
#include <iostream>
#include <string>
#include <vector>

#include "client/exporters/atomic_file.h"
#include "client/view/page.h"
#include "core/shapes.h"

namespace {

using affskel::client::ViewInput;
using affskel::client::ViewPoint;
using affskel::client::ViewPointCollector;

constexpr double kEdge = 4, kVolume = kEdge * kEdge * kEdge;
constexpr double kHighestShare = 0.125;
constexpr unsigned kSquares = 8, kVertices = kSquares + 1;

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
  for (unsigned row = 0; row < kVertices; ++row) {
    for (unsigned column = 0; column < kVertices; ++column) {
      const double place = double(column) / kSquares;
      for (const double c : {kEdge * place, kEdge * row / kSquares, kEdge / 2}) input.sheet.add_xyz(c);
      input.sheet.add_strength(0.5 + 0.05 * column);
      input.sheet.add_erosion(kVolume * kHighestShare * place * place * place);
    }
  }
  for (unsigned row = 0; row < kSquares; ++row) {
    for (unsigned column = 0; column < kSquares; ++column) {
      const unsigned a = row * kVertices + column, b = a + 1, c = a + kVertices, d = c + 1;
      for (const unsigned v : {a, b, c, b, d, c}) input.sheet.add_corners(v);
    }
  }
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
  const bool sheet = arguments.size() == 2 && arguments[0] == "sheet";
  const bool thinned = arguments.size() == 3 && arguments[0] == "thinned";
  if (!sheet && !thinned) {
    std::cerr << "usage: affskel_made_up_page sheet FILE | thinned N FILE\n";
    return 2;
  }
  try {
    const ViewInput input =
        sheet ? sheet_page() : thinned_page(static_cast<unsigned>(std::stoul(arguments[1])));
    affskel::client::AtomicFile file(arguments.back());
    file.write(affskel::client::view_page(input));
    file.commit();
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
}
