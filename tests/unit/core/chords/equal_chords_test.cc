#include "core/chords/equal_chords.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/barrier/barriers.h"
#include "core/chords/chord_fields.h"
#include "core/chords/chord_sheet.h"
#include "core/infimum/least_chord.h"
#include "core/lattice/lattice_coordinates.h"
#include "core/shapes/shapes.h"

namespace affskel::core {
namespace {

// A refined field with its shocks before and after.
struct Placed {
  ErodedSolid eroded;
  PieceInput input;
  std::vector<ChordShock> before, after;

  Placed(const Mesh& mesh, const std::array<Vec3, 3>& axes, unsigned threads = 1)
      : eroded(mesh, axes, "triangles+sphere:200", true),
        input(eroded.solid),
        before(chord_shocks(eroded.lattice, eroded.field, constants_of_infimum())),
        after(before) {
    place_at_equal_chords(eroded.solid, eroded.lattice, eroded.field,
                                   {input, eroded.saddles, threads}, after, nullptr);
  }
};

}  // namespace
}  // namespace affskel::core
