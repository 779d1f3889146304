#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "client/render/image.h"
#include "core/mesh/mesh.h"

namespace affskel::client {

/// An orthographic view of the scene.
struct View {
  core::Vec3 right;   ///< unit, to the right of the picture
  core::Vec3 up;      ///< unit
  core::Vec3 toward;  ///< unit, from the scene to the viewer
};

/// A ball or an ellipsoid to draw.
struct Ball {
  core::Vec3 centre;
  Rgb colour;
};

/// Draws one view: opaque balls, facets, sheets and curves, depth-buffered, inside a translucent surface.
/// Works on a grid of 2 x 2 samples per pixel.  The surface is composed without sorting: each of its layers
/// takes a share of the light, and the layers in front of a ball and those behind it are kept apart.
class Panel {
 public:
  static constexpr int kSamples = 2;  ///< per pixel and axis

  /// @param scale pixels per mesh unit; @param centre is shown in the middle of the picture.
  Panel(int width, int height, const View& view, const core::Vec3& centre, double scale);

  /// All balls, ellipsoids and facets first, then the surface.
  void draw_ball(const Ball& ball, double radius);
  /// An ellipsoid about the ball's centre: the image of the unit ball when the unit vectors become
  /// `half_axes`, mesh units.  Nothing when these lie in a plane.
  void draw_ellipsoid(const Ball& ball, const std::array<core::Vec3, 3>& half_axes);
  /// The mesh's triangles, opaque and flat, seen from either side.
  void draw_facets(const core::Mesh& mesh, Rgb colour);
  /// The same with a colour per vertex, blended in between; facets that look thinner than a pixel are drawn
  /// as lines of one, so that a sheet does not vanish where it is seen from its edge.
  void draw_sheet(const core::Mesh& mesh, const std::vector<Rgb>& colours);
  /// The segments of curves, opaque and lit alike all round.  @param width of the lines, pixels.
  void draw_curves(const std::vector<core::Vec3>& points, const std::vector<core::Segment>& segments,
                   const std::vector<Rgb>& colours, double width);
  /// @param normals one per triangle and corner, unit or zero.
  void draw_surface(const core::Mesh& mesh, const std::vector<core::Vec3>& normals);

  /// The finished picture on white.
  Image resolve() const;

 private:
  struct Layers {
    float transmittance = 1;  // share of the light from behind that passes all layers
    float weight = 0;         // sum of the layers' opacities
    Rgb colour{0, 0, 0};      // their colours, weighted by opacity
    void add(float opacity, Rgb layer);
    Rgb over(Rgb behind) const;
  };
  struct Sample {
    float depth;  // of the nearest ball or facet, along the view; larger is nearer
    Rgb solid;    // its colour
    bool covered = false;
    Layers front, back;
  };

  struct Projected {
    double x, y, depth;
  };
  Projected project(const core::Vec3& point) const;
  // Flat, lit on the side that the viewer sees.  `darkest`: brightness where no light falls.
  void draw_facet(const std::array<core::Vec3, 3>& corners, const std::array<Rgb, 3>& colours,
                  double darkest);
  // A line of `width` samples from a to b.
  void draw_line(const Projected& a, const Projected& b, Rgb colour_a, Rgb colour_b, double width);
  // Draws a facet that looks thinner than a pixel as a line along its longest side; false for any other.
  bool draw_profile(const std::array<core::Vec3, 3>& corners, const std::array<Rgb, 3>& colours);
  // Keeps what is nearer.
  static void cover(Sample& sample, float depth, Rgb colour);
  const Sample& at(int x, int y) const {
    return samples_[std::size_t(y) * std::size_t(columns_) + std::size_t(x)];
  }
  Sample& at(int x, int y) { return samples_[std::size_t(y) * std::size_t(columns_) + std::size_t(x)]; }

  int columns_, rows_;  // of samples
  View view_;
  core::Vec3 centre_;
  double scale_;  // samples per mesh unit
  std::vector<Sample> samples_;
};

/// Normals per triangle and corner: the area-weighted mean over the triangles around the vertex that bend
/// away by less than 50 degrees, so that round parts look round and edges stay edges.
std::vector<core::Vec3> corner_normals(const core::Mesh& mesh);

}  // namespace affskel::client
