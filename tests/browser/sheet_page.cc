// Writes a page whose skeleton is a sheet of `chords`, made up so that a test knows every number on it:
// affskel_sheet_page FILE.  A box of 4 x 4 x 4 with a level sheet of 8 x 8 squares through its middle; the
// strength of a vertex is 0.5 + 0.05 times its column, the colour of its E goes evenly from left to right.
#include <exception>
#include <iostream>

#include "client/exporters/atomic_file.h"
#include "client/view/page.h"
#include "core/shapes.h"

namespace {

using affskel::client::ViewInput;
using affskel::client::ViewPoint;

constexpr unsigned kSquares = 8, kVertices = kSquares + 1;
constexpr double kVolume = 64, kHighestShare = 0.125;

void add_sheet(ViewInput& input) {
  input.sheet_is_skeleton = true;
  for (unsigned row = 0; row < kVertices; ++row) {
    for (unsigned column = 0; column < kVertices; ++column) {
      for (const double c : {0.5 * column, 0.5 * row, 2.0}) input.sheet.add_xyz(c);
      input.sheet.add_strength(0.5 + 0.05 * column);
      input.sheet.add_erosion(kVolume * kHighestShare * column * column * column /
                              (kSquares * kSquares * kSquares));
    }
  }
  for (unsigned row = 0; row < kSquares; ++row) {
    for (unsigned column = 0; column < kSquares; ++column) {
      const unsigned corner = row * kVertices + column;
      for (const unsigned v : {corner, corner + 1, corner + kVertices}) input.sheet.add_corners(v);
      for (const unsigned v : {corner + 1, corner + kVertices + 1, corner + kVertices})
        input.sheet.add_corners(v);
    }
  }
}

ViewInput made_up() {
  ViewInput input;
  input.job.set_name("sheet");
  input.job.set_id("0123456789abcdef0123456789abcdef");
  input.job.mutable_prepared()->set_volume(kVolume);
  input.job.mutable_prepared()->set_spacing(0.5);
  input.mesh = affskel::core::make_box(4, 4, 4);
  input.operator_name = "chords";
  input.grid.axes = {{{0.5, 0, 0}, {0, 0.5, 0}, {0, 0, 0.5}}};
  input.grid.lattice_steps = {1, 1, 1};
  for (std::uint16_t k = 1; k < kVertices - 1; ++k) {
    ViewPoint point;
    point.step = {4, 4, k};
    point.share = kHighestShare;
    point.inward = {0, 0, 1};
    input.points.push_back(point);
  }
  input.job.mutable_prepared()->set_points(input.points.size());
  add_sheet(input);
  return input;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  try {
    affskel::client::AtomicFile file(argv[1]);
    file.write(affskel::client::view_page(made_up()));
    file.commit();
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
}
