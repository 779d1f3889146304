#pragma once

#include <array>
#include <vector>

#include "client/render/image.h"
#include "client/render/raster.h"
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

/// How a translucent surface looks.
struct Glass {
  Rgb dark, light;  ///< where no light falls, and where all does
  float clear = 0;  ///< opacity where it faces the viewer, 0 .. 1
  float rim = 0;    ///< added to that at its outline, 0 .. 1
};

/// A body on a light background, and on a dark one.
inline constexpr Glass kGlassOnLight{{0.30f, 0.38f, 0.50f}, {0.80f, 0.86f, 0.93f}, 0.10f, 0.42f};
inline constexpr Glass kGlassOnDark{{0.42f, 0.50f, 0.62f}, {0.86f, 0.91f, 0.97f}, 0.08f, 0.42f};
/// An eroded solid inside it.
inline constexpr Glass kErodedGlass{{0.62f, 0.33f, 0.10f}, {0.98f, 0.66f, 0.36f}, 0.28f, 0.50f};

/// Where a point is seen, pixels from the upper left corner of a panel; a greater depth is nearer to the viewer.
struct PanelPlace {
  double x = 0, y = 0, depth = 0;
};

/// Draws one view: opaque balls, sheets and curves, depth-buffered, inside translucent surfaces.  Works on a
/// grid of 2 x 2 samples per pixel.  Surfaces are composed without sorting: each of their layers takes a
/// share of the light, and the layers in front of a ball and those behind it are kept apart.
///
/// A sample takes 60 bytes: a large picture is drawn in bands of whole rows, all of the scene for each.
class Panel {
 public:
  static constexpr int kSamples = 2;                          ///< per pixel and axis
  static constexpr std::size_t kBand = std::size_t(1) << 17;  ///< samples that a band has at most, or one row

  /// Of the whole picture.
  /// @param scale pixels per mesh unit; @param centre is shown in the middle of the picture.
  Panel(int width, int height, const View& view, const core::Vec3& centre, double scale);
  /// Of its uppermost band.
  static Panel banded(int width, int height, const View& view, const core::Vec3& centre, double scale);

  /// Empties it for the band below; false where there is none.
  bool next_band();
  /// The first row of pixels of the band.
  int top() const { return rows_.first / kSamples; }

  PanelPlace place(const core::Vec3& point) const;

  /// All that is opaque first, then the surfaces.
  void draw_ball(const Ball& ball, double radius);
  /// An ellipsoid about the ball's centre: the image of the unit ball when the unit vectors become
  /// `half_axes`, mesh units.  Nothing when these lie in a plane.
  void draw_ellipsoid(const Ball& ball, const std::array<core::Vec3, 3>& half_axes);
  /// The mesh's triangles, opaque and flat, seen from either side, with a colour per vertex that is blended
  /// in between; facets that are seen from their edge and look thinner than a pixel are drawn as lines of
  /// one, so that a sheet does not vanish there.
  void draw_sheet(const core::Mesh& mesh, const std::vector<Rgb>& colours);
  /// The segments of curves, opaque and lit alike all round.  @param width of the lines, pixels.
  void draw_curves(const std::vector<core::Vec3>& points, const std::vector<core::Segment>& segments,
                   const std::vector<Rgb>& colours, double width);
  /// @param normals one per triangle and corner, unit or zero.
  void draw_surface(const core::Mesh& mesh, const std::vector<core::Vec3>& normals,
                    const Glass& glass = kGlassOnLight);

  /// The surface that the viewer sees, depth-buffered, in front of all else.
  /// @param normals as of draw_surface. @param colours one per triangle. @param opacity 0 .. 1.
  void draw_shell(const core::Mesh& mesh, const std::vector<core::Vec3>& normals,
                  const std::vector<Rgb>& colours, float opacity);

  /// The finished picture; of the band alone where it has one.
  Image resolve(Rgb background = kWhite) const;

 private:
  Panel(int width, int height, const View& view, const core::Vec3& centre, double scale, std::size_t samples);

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

  struct ShellSample {
    float depth = 0;
    Rgb colour;
    float opacity = 0;  // 0: no shell
  };

  struct Projected {
    double x, y, depth;
  };
  Projected project(const core::Vec3& point) const;
  // How bright a flat facet is.
  float light_on(const std::array<core::Vec3, 3>& corners) const;
  // Flat, lit on the side that the viewer sees.
  void draw_facet(const std::array<core::Vec3, 3>& corners, const std::array<Rgb, 3>& colours);
  // Flat, towards the viewer.  @param radius pixels.
  void draw_disc(const core::Vec3& centre, Rgb colour, double radius);
  // A line of `width` samples from a to b.
  void draw_line(const Projected& a, const Projected& b, Rgb colour_a, Rgb colour_b, double width);
  // Draws a facet that is seen from its edge, thinner than a pixel, as a line along its longest side; false
  // for any other.
  bool draw_profile(const std::array<core::Vec3, 3>& corners, const std::array<Rgb, 3>& colours);
  // Calls paint(x, y, depth, normal) for every sample of a triangle; normal() is the interpolated one, unit or zero.
  template <class Paint>
  void draw_smooth(const core::Mesh& mesh, const std::vector<core::Vec3>& normals, std::size_t triangle,
                   const Paint& paint);
  // Keeps what is nearer.
  static void cover(Sample& sample, float depth, Rgb colour);
  std::size_t index_of(int x, int y) const {
    return std::size_t(y - rows_.first) * std::size_t(columns_) + std::size_t(x);
  }
  Sample& at(int x, int y) { return samples_[index_of(x, y)]; }

  int columns_, height_;  // of the whole picture, samples
  SampleRows rows_;       // of the band
  View view_;
  core::Vec3 centre_;
  double scale_;                    // samples per mesh unit
  std::vector<Sample> samples_;     // of the band
  std::vector<ShellSample> shell_;  // as many, or none
};

/// Normals per triangle and corner: the area-weighted mean over the triangles around the vertex that bend
/// away by less than 50 degrees, so that round parts look round and edges stay edges.
std::vector<core::Vec3> corner_normals(const core::Mesh& mesh);

}  // namespace affskel::client
