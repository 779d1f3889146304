#pragma once

#include <algorithm>

namespace affskel::core {

/// Bounds on the strength of the ridge surface and of ridge curves, radians.
struct RidgeBounds {
  double low = 6;     ///< the ridge ends where its strength falls below this, > 0; the threshold of `ridge`
  double high = 6.5;  ///< a piece has this strength somewhere, >= low
};

/// What the skeleton of `ridge` is made with, found by experiments; tests take other values.
/// Lengths called radii are distances to the surface.  Reasons: README.md in worker/core.
struct RidgeConstants {
  // Smoothed derivatives: the Gaussian's standard deviation as a share of the local depth, and its bounds,
  // spacings, at most 32: what the lattice carries, and what is affordable.
  double width = 0.35;
  double min_width = 2;
  double max_width = 9;
  double width_at(double depth) const { return std::clamp(width * depth, min_width, max_width); }

  // What counts as ridge: not nearer to the surface than this share of the local depth, nor than so many
  // spacings: in hollows of the surface E is large.  Nor than a share of the radius of a ball in the solid
  // that touches the surface at the same place; noise may reach into the ball.  A larger share where noise makes the
  // surface cross itself and the ridge lies along it: without noise, forks have such ridges.  And from this share of
  // the lower bound on, for the line where it ends.
  double strip = 0.25;  ///< half the least width of a surface in a limb, radii: else it is a curve
  double min_radius_share = 0.315;
  double min_ball_share = 0.25;
  double noisy_ball_share = 0.565;
  double min_ball = 0.7;  ///< of the ball's radius: so far from its middle there may be surface
  double min_radius = 1;
  double weak_share = 0.125;

  // Anchors.  About the centre of a ball E falls alike in all directions, and e is any of them: lambda_3 /
  // lambda_1 is at most max_roundness somewhere in a piece.  A piece has this area at least, radii squared; a
  // stretch of a ridge curve this length, radii.  Gaps between strong places are closed up to twice this width, radii.
  double max_roundness = 0.8;
  double gap = 0.5;
  double min_area = 0.9;
  double min_length = 2;

  // Limbs: so many times as long as thick, that end farther than so many radii and spacings from what is anchored.
  double limb_reach = 0.9;
  double end_radii = 1.2;
  double end_spacings = 1;

  // So many radii from what is anchored lies the middle of a component at most, or else it is anchored, too.
  double middle_radii = 0.5;
};

}  // namespace affskel::core
