#include "client/view/sheet_pieces.h"

#include <gtest/gtest.h>

namespace affskel::client {
namespace {

// A square of that edge in two triangles, away from all others.
void add_square(v1::TriangleMesh& sheet, double edge, double strength) {
  const auto first = static_cast<std::uint32_t>(sheet.xyz_size() / 3);
  for (const auto& [x, y] : {std::pair(0., 0.), {1., 0.}, {1., 1.}, {0., 1.}}) {
    for (const double c : {100.0 * first + edge * x, edge * y, 7.0}) sheet.add_xyz(c);
    sheet.add_strength(strength);
  }
  for (const std::uint32_t v : {0u, 1u, 2u, 0u, 2u, 3u}) sheet.add_corners(first + v);
}

TEST(SheetPieces, WeighAreaTimesStrength) {
  v1::TriangleMesh sheet;
  add_square(sheet, 1, 0.5);   // 0.5
  add_square(sheet, 3, 0.5);   // 4.5
  add_square(sheet, 2, 0.75);  // 3
  const SheetPieces pieces = sheet_pieces(sheet);
  EXPECT_EQ(pieces.piece, (std::vector<std::uint32_t>{2, 2, 0, 0, 1, 1}));
  EXPECT_EQ(pieces.shares, (std::vector<double>{4.5 / 8, 3.0 / 8, 0.5 / 8}));
}

TEST(SheetPieces, ACommonVertexJoins) {
  v1::TriangleMesh sheet;
  add_square(sheet, 1, 0.5);
  add_square(sheet, 3, 0.7);
  for (const std::uint32_t v : {3u, 2u, 4u}) sheet.add_corners(v);
  const SheetPieces pieces = sheet_pieces(sheet);
  EXPECT_EQ(pieces.piece, (std::vector<std::uint32_t>(5, 0)));
  EXPECT_EQ(pieces.shares, (std::vector<double>{1})) << "exactly: the slider ends there";
}

TEST(SheetPieces, CurvesJoinAndWeighAsSquaresOverTheirSegments) {
  v1::TriangleMesh sheet;
  add_square(sheet, 1, 0.5);  // 0.5
  add_square(sheet, 2, 1);    // 4, at x = 400
  add_square(sheet, 1, 1);    // of its last two vertices only a segment is left
  sheet.mutable_corners()->Truncate(12);
  for (const std::uint32_t v : {8u, 9u, 6u, 7u}) sheet.add_segments(v);  // 1; 4, of the second square
  const SheetPieces pieces = sheet_pieces(sheet);
  EXPECT_EQ(pieces.piece, (std::vector<std::uint32_t>{2, 2, 0, 0, 1, 0}));
  EXPECT_EQ(pieces.shares, (std::vector<double>{8 / 9.5, 1 / 9.5, 0.5 / 9.5}));
  for (const std::uint32_t v : {0u, 8u}) sheet.add_segments(v);
  EXPECT_EQ(sheet_pieces(sheet).shares.size(), 2u) << "the first square and the first curve are one";
}

TEST(SheetPieces, EquallyHeavyOnesKeepTheirOrder) {
  v1::TriangleMesh sheet;
  add_square(sheet, 2, 0.25);
  add_square(sheet, 1, 1);
  EXPECT_EQ(sheet_pieces(sheet).piece, (std::vector<std::uint32_t>{0, 0, 1, 1}));
}

TEST(SheetPieces, OfNothingThereAreNone) {
  v1::TriangleMesh sheet;
  EXPECT_TRUE(sheet_pieces(sheet).shares.empty());
  add_square(sheet, 1, 0);
  EXPECT_EQ(sheet_pieces(sheet).shares, (std::vector<double>{1})) << "no weight at all";
}

}  // namespace
}  // namespace affskel::client
