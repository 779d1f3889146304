#pragma once

namespace affskel::core {

/// What the sheet of `ridge` is made with, found by experiments; nobody but tests takes other values.
/// Reasons: README.md in worker/core.
struct RidgeConstants {
  // Smoothed derivatives: the Gaussian's standard deviation as a share of the local depth, and its bounds,
  // spacings, at most 32: what the lattice carries, and what is affordable.
  double width = 0.35;
  double min_width = 2;
  double max_width = 9;

  // The sheet before it is cut.
  double weak_share = 0.125;   ///< least strength, as a share of the lower bound: what may join pieces
  double min_erosion = 0.002;  ///< see RidgeValues

  // Rims: lambda_3 / lambda_1 is at most max_roundness somewhere in a piece: about the centre of a ball E
  // falls alike in all directions, and e is any of them.  Pieces that the weaker sheet connects are weighed
  // as one, and dropped with less than the significance as share of the area above the lower bound in their
  // part.
  double max_roundness = 0.8;
  double significance = 0.001;

  double max_flap = 0.01;  ///< flaps of at most this share of their piece's area are cut off
  double max_hole = 0.01;  ///< holes whose rim spans at most this share of it are closed

  // Round stretches: lambda_2 / lambda_1, averaged this far to both sides, radii, is at least the lower
  // bound, and somewhere the higher one.  In elliptic cylinders whose axes are as 1 to 0.9, 0.8, 0.7, 0.6 and
  // 0.5 it is 0.84, 0.69, 0.55, 0.43 and 0.31.
  double low_ratio = 0.4;
  double high_ratio = 0.5;
  double smoothing = 1;

  // Curves in the place of strips.
  double reach = 1;          ///< how far from a curve its sheet reaches, radii; what reaches farther is wide
  double window = 1.25;      ///< strips are looked at in windows of this length, radii,
  double step = 0.5;         ///< each one so far on from the one before
  double round_ratio = 0.9;  ///< from this lambda_2 / lambda_1 on the strip's direction is chance
  double min_length = 0.8;   ///< of a stretch, mean radii, unless all of it is that round

  double max_join = 2;  ///< the longest way between pieces, in the radius of the larger section at its ends
};

}  // namespace affskel::core
