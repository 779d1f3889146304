#include <gtest/gtest.h>

#include <cmath>

#include "core/chords/chord_fields.h"
#include "core/chords/chord_sheet.h"
#include "core/shapes/shapes.h"

// The sheet of `chords` of fields over all directions.

namespace affskel::core {
namespace {

ChordSheet sheet_of(const ErodedSolid& eroded) {
  const PieceInput input(eroded.solid);
  const RefinedPieces refined{input, eroded.saddles};
  return chord_sheet(eroded.solid, eroded.lattice, eroded.field, {.refined = &refined});
}

// The level sets of a ball's E are spheres: only the centre is a shock, however fine the lattice is.
TEST(ChordsOfInfimum, ABallShrinksToItsCentre) {
  for (const double h : {0.11, 0.05}) {
    SCOPED_TRACE(h);
    const ErodedSolid ball(make_sphere(1, 1280), cubic_axes(h), "sphere:100", true);
    const ChordSheet sheet = sheet_of(ball);
    EXPECT_FALSE(sheet.shocks.empty());
    for (const ChordShock& shock : sheet.shocks) EXPECT_LT(norm(ball.place(shock.position)), 2 * h);
  }
}

// The two chords that mirror each other in the torus's plane are the least ones on an annulus of that plane.  With the
// least share that a finite set needs, the small jumps at its outer rim are taken for those of facets.
TEST(ChordsOfInfimum, ATorusOfFewTrianglesGivesTheWholeFlatAnnulus) {
  const double h = 0.2;
  const ErodedSolid torus(make_torus(4, 2, 256), cubic_axes(h), "triangles", true);
  const ChordSheet sheet = sheet_of(torus);
  for (const SheetVertex& v : sheet.vertices) EXPECT_LT(std::abs(torus.place(v.position).z), 0.05 * h);
  const ChordSheet with_share = chord_sheet(torus.solid, torus.lattice, torus.field);
  EXPECT_GT(sheet.shocks.size(), 1.15 * static_cast<double>(with_share.shocks.size()));
}

// In an ellipsoid the normals turn and nowhere jump; half-way up a triangular prism they jump from wall to wall.
TEST(ChordsOfInfimum, ASheetTellsWhereNormalsOnlyTurn) {
  const ErodedSolid ellipsoid(make_ellipsoid(3, 2, 1, 1280), cubic_axes(0.17), "sphere:100", true);
  for (const SheetVertex& v : sheet_of(ellipsoid).vertices) EXPECT_TRUE(v.turns);
  const ErodedSolid prism(make_cylinder(1, 4, 3), cubic_axes(0.13), "sphere:100", true);
  const ChordSheet sheet = sheet_of(prism);
  for (const SheetVertex& v : chord_sheet(prism.solid, prism.lattice, prism.field).vertices)
    EXPECT_FALSE(v.turns);
  std::size_t jumping = 0;
  for (const SheetVertex& v : sheet.vertices) {
    const Vec3 p = prism.place(v.position);
    if (std::abs(p.z - 2) > 0.35 || std::hypot(p.x, p.y) > 0.15) continue;
    ++jumping;
    EXPECT_FALSE(v.turns);
  }
  EXPECT_GT(jumping, 10U);
}

}  // namespace
}  // namespace affskel::core
