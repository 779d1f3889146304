#pragma once

#include <algorithm>

namespace affskel::core {

/// Bounds on the strength of the ridge surface and of ridge curves, radians.
struct RidgeBounds {
  double low = 6;     ///< the ridge ends where its strength falls below this, > 0; the threshold of `ridge`
  double high = 6.5;  ///< a piece has this strength somewhere, >= low
};

/// Of smoothed derivatives: the Gaussian's standard deviation as a share of the local depth, and its bounds, spacings, at
/// most 32: what the lattice carries, and what is affordable.
struct RidgeWidths {
  double share = 0.35, least = 2, greatest = 9;
  double at(double depth) const { return std::clamp(share * depth, least, greatest); }
};

/// What else the skeleton of `ridge` is made with, found by experiments.
/// Lengths called radii are distances to the surface.  Reasons: README.md in worker/core.
struct RidgeConstants {
  // What counts as ridge: not nearer to the surface than this share of the local depth, nor than so many
  // spacings: in hollows of the surface E is large.  Nor than a share of the radius of a ball in the solid
  // that touches the surface at the same place; noise may reach into the ball.  A larger share where noise makes the
  // surface cross itself and the ridge lies along it: without noise, forks have such ridges.  And from this share of
  // the lower bound on, for the line where it ends.
  /// Half the least width of a surface in a limb, radii: else it is a curve.
  static constexpr double strip = 0.25;
  static constexpr double min_radius_share = 0.315;
  static constexpr double min_ball_share = 0.25;
  static constexpr double noisy_ball_share = 0.565;
  /// Of the ball's radius: so far from its middle there may be surface.
  static constexpr double min_ball = 0.7;
  static constexpr double min_radius = 1;
  static constexpr double weak_share = 0.125;

  // Anchors.  About the centre of a ball E falls alike in all directions, and e is any of them: lambda_3 /
  // lambda_1 is at most max_roundness somewhere in a piece.  A piece has this area at least, radii squared; a
  // stretch of a ridge curve this length, radii.  Gaps between strong places are closed up to twice this width, radii.
  static constexpr double max_roundness = 0.8;
  static constexpr double gap = 0.5;
  static constexpr double min_area = 0.9;
  static constexpr double min_length = 2;

  // Limbs: so many times as long as thick, that end farther than so many radii and spacings from what is anchored.
  static constexpr double limb_reach = 0.9;
  static constexpr double end_radii = 1.2;
  static constexpr double end_spacings = 1;

  // So many radii from what is anchored lies the middle of a component at most, or else it is anchored, too.
  static constexpr double middle_radii = 0.5;
};

}  // namespace affskel::core
