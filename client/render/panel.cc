#include "client/render/panel.h"

#include <array>
#include <cmath>

#include "client/render/raster.h"
#include "core/base/unit.h"

namespace affskel::client {
namespace {

using core::unit;
using core::Vec3;

constexpr double kCreaseCosine = 0.643;       // of 50 degrees
constexpr double kSheetShade = 0.65;          // where no light falls: colours must be told from each other
constexpr double kProfile = Panel::kSamples;  // thickness of a line of one pixel, in samples
constexpr double kEdgeOn = 0.2;      // cosine between view and normal: below, it is seen from its edge
constexpr float kCurveLight = 0.9f;  // a curve has no side to be lit

float clamp01(double v) {
  return static_cast<float>(std::min(1.0, std::max(0.0, v)));
}

// Of a mean of unit vectors, for each sample: nothing that needs the care of core's.
Vec3 direction_of(const Vec3& mean) {
  const double length = core::norm(mean);
  return length > 0 ? (1 / length) * mean : mean;
}

// Light from the viewer's upper left.
double lambert(double right, double up, double toward) {
  return std::max(0.0, -0.42 * right + 0.55 * up + 0.72 * toward);
}

}  // namespace

void Panel::Layers::add(float opacity, Rgb layer) {
  transmittance *= 1 - opacity;
  weight += opacity;
  colour = colour + opacity * layer;
}

Rgb Panel::Layers::over(Rgb behind) const {
  if (weight <= 0) return behind;
  return mix((1 / weight) * colour, behind, transmittance);
}

Panel::Panel(int width, int height, const View& view, const Vec3& centre, double scale, std::size_t samples)
    : columns_(width * kSamples),
      height_(height * kSamples),
      rows_{0, height_},
      view_(view),
      centre_(centre),
      scale_(scale * kSamples) {
  const auto pixels = static_cast<int>(samples / (std::size_t(columns_) * kSamples));
  rows_.end = std::min(height_, kSamples * std::max(1, pixels));
  samples_.resize(std::size_t(columns_) * std::size_t(rows_.end));
}

Panel::Panel(int width, int height, const View& view, const Vec3& centre, double scale)
    : Panel(width, height, view, centre, scale,
            std::size_t(width) * std::size_t(height) * kSamples * kSamples) {}

Panel Panel::banded(int width, int height, const View& view, const Vec3& centre, double scale) {
  return {width, height, view, centre, scale, kBand};
}

bool Panel::next_band() {
  if (rows_.end == height_) return false;
  rows_ = {rows_.end, std::min(height_, 2 * rows_.end - rows_.first)};
  samples_.assign(std::size_t(columns_) * std::size_t(rows_.end - rows_.first), Sample{});
  shell_.clear();
  return true;
}

PanelPlace Panel::place(const Vec3& point) const {
  const Projected at = project(point);
  return {at.x / kSamples, at.y / kSamples, at.depth / kSamples};
}

Panel::Projected Panel::project(const Vec3& point) const {
  const Vec3 p = point - centre_;
  return {columns_ / 2.0 + scale_ * core::dot(view_.right, p),
          height_ / 2.0 - scale_ * core::dot(view_.up, p), scale_ * core::dot(view_.toward, p)};
}

void Panel::cover(Sample& sample, float depth, Rgb colour) {
  if (sample.covered && depth <= sample.depth) return;
  sample.covered = true;
  sample.depth = depth;
  sample.solid = colour;
}

void Panel::draw_ball(const Ball& ball, double radius) {
  const Projected c = project(ball.centre);
  const double r = radius * kSamples;
  const int x_end = std::min(columns_ - 1, static_cast<int>(std::ceil(c.x + r)));
  const int y_end = std::min(rows_.end - 1, static_cast<int>(std::ceil(c.y + r)));
  for (int y = std::max(rows_.first, static_cast<int>(std::floor(c.y - r))); y <= y_end; ++y) {
    for (int x = std::max(0, static_cast<int>(std::floor(c.x - r))); x <= x_end; ++x) {
      const double dx = (x + 0.5 - c.x) / r, dy = (y + 0.5 - c.y) / r;
      const double rest = 1 - dx * dx - dy * dy;
      if (rest < 0) continue;
      const double height = std::sqrt(rest);
      const auto depth = static_cast<float>(c.depth + height * r);
      const double light = 0.55 + 0.45 * lambert(dx, -dy, height);
      cover(at(x, y), depth, static_cast<float>(light) * ball.colour);
    }
  }
}

void Panel::draw_disc(const Vec3& centre, Rgb colour, double radius) {
  const Projected c = project(centre);
  const double r = radius * kSamples;
  const int x_end = std::min(columns_ - 1, static_cast<int>(std::ceil(c.x + r)));
  const int y_end = std::min(rows_.end - 1, static_cast<int>(std::ceil(c.y + r)));
  for (int y = std::max(rows_.first, static_cast<int>(std::floor(c.y - r))); y <= y_end; ++y) {
    for (int x = std::max(0, static_cast<int>(std::floor(c.x - r))); x <= x_end; ++x) {
      const double dx = x + 0.5 - c.x, dy = y + 0.5 - c.y;
      if (dx * dx + dy * dy <= r * r) cover(at(x, y), static_cast<float>(c.depth), colour);
    }
  }
}

void Panel::draw_ellipsoid(const Ball& ball, const std::array<Vec3, 3>& half_axes) {
  std::array<Vec3, 3> axis{};  // in samples: right, up, towards the viewer
  for (std::size_t a = 0; a < 3; ++a) {
    axis[a] = {scale_ * core::dot(view_.right, half_axes[a]), scale_ * core::dot(view_.up, half_axes[a]),
               scale_ * core::dot(view_.toward, half_axes[a])};
  }
  const double volume = core::dot(axis[0], core::cross(axis[1], axis[2]));
  if (volume == 0) return;
  // Rows of the inverse: u = (row . d) takes a place d about the centre into the unit ball.
  const std::array<Vec3, 3> row = {(1 / volume) * core::cross(axis[1], axis[2]),
                                   (1 / volume) * core::cross(axis[2], axis[0]),
                                   (1 / volume) * core::cross(axis[0], axis[1])};
  const Vec3 along{row[0].z, row[1].z, row[2].z};
  const double steep = core::dot(along, along);
  const double wide = core::norm(Vec3{axis[0].x, axis[1].x, axis[2].x});
  const double high = core::norm(Vec3{axis[0].y, axis[1].y, axis[2].y});
  const Projected c = project(ball.centre);
  const int x_end = std::min(columns_ - 1, static_cast<int>(std::ceil(c.x + wide)));
  const int y_end = std::min(rows_.end - 1, static_cast<int>(std::ceil(c.y + high)));
  for (int y = std::max(rows_.first, static_cast<int>(std::floor(c.y - high))); y <= y_end; ++y) {
    for (int x = std::max(0, static_cast<int>(std::floor(c.x - wide))); x <= x_end; ++x) {
      // Where |u|^2 = 1 nearest to the viewer, u = at + depth along.
      const double right = x + 0.5 - c.x, up = c.y - (y + 0.5);
      const Vec3 at_zero{row[0].x * right + row[0].y * up, row[1].x * right + row[1].y * up,
                         row[2].x * right + row[2].y * up};
      const double half = core::dot(at_zero, along);
      const double rest = half * half - steep * (core::dot(at_zero, at_zero) - 1);
      if (rest < 0) continue;
      const double depth = (std::sqrt(rest) - half) / steep;
      const Vec3 u = at_zero + depth * along;
      const Vec3 normal = unit((u.x * row[0] + u.y * row[1]) + u.z * row[2]);
      const double light = 0.55 + 0.45 * lambert(normal.x, normal.y, normal.z);
      cover(at(x, y), static_cast<float>(c.depth + depth), static_cast<float>(light) * ball.colour);
    }
  }
}

void Panel::draw_sheet(const core::Mesh& mesh, const std::vector<Rgb>& colours) {
  for (const core::Triangle& c : mesh.triangles) {
    const std::array<Vec3, 3> places = {mesh.points[c[0]], mesh.points[c[1]], mesh.points[c[2]]};
    const std::array<Rgb, 3> paint = {colours[c[0]], colours[c[1]], colours[c[2]]};
    if (!draw_profile(places, paint)) draw_facet(places, paint);
  }
}

// Two sides meet where a facet is seen from its edge: their mean there, so that a wavy sheet does not
// flicker.
float Panel::light_on(const std::array<Vec3, 3>& corners) const {
  const Vec3 n = unit(core::cross(corners[1] - corners[0], corners[2] - corners[0]));
  const double right = core::dot(n, view_.right), up = core::dot(n, view_.up);
  const double facing = core::dot(n, view_.toward), side = facing < 0 ? -1 : 1;
  const double near = lambert(side * right, side * up, side * facing);
  const double far = lambert(-side * right, -side * up, side * facing);
  const double own = 0.5 * (1 + std::min(1.0, std::fabs(facing) / kEdgeOn));
  return static_cast<float>(kSheetShade + (1 - kSheetShade) * (own * near + (1 - own) * far));
}

void Panel::draw_facet(const std::array<Vec3, 3>& corners, const std::array<Rgb, 3>& colours) {
  const std::array<Projected, 3> p = {project(corners[0]), project(corners[1]), project(corners[2])};
  const float light = light_on(corners);
  const std::array<ScreenPoint, 3> screen = {{{p[0].x, p[0].y}, {p[1].x, p[1].y}, {p[2].x, p[2].y}}};
  for_each_sample(screen, columns_, rows_, [&](int x, int y, double w0, double w1, double w2) {
    const Rgb colour = static_cast<float>(w0) * colours[0] + static_cast<float>(w1) * colours[1] +
                       static_cast<float>(w2) * colours[2];
    cover(at(x, y), static_cast<float>((w0 * p[0].depth + w1 * p[1].depth) + w2 * p[2].depth),
          light * colour);
  });
}

// A facet that looks thin because it is small or a sliver lies among others that cover its place: a line
// along it would lie over them.
bool Panel::draw_profile(const std::array<Vec3, 3>& corners, const std::array<Rgb, 3>& colours) {
  const Vec3 normal = unit(core::cross(corners[1] - corners[0], corners[2] - corners[0]));
  if (std::fabs(core::dot(normal, view_.toward)) >= kEdgeOn) return false;
  const std::array<Projected, 3> p = {project(corners[0]), project(corners[1]), project(corners[2])};
  // The longest side of the projection; its height over that side is how thick the facet looks.
  std::size_t a = 0, b = 1;
  double longest = 0;
  for (std::size_t e = 0; e < 3; ++e) {
    const std::size_t next = (e + 1) % 3;
    const double length = std::hypot(p[next].x - p[e].x, p[next].y - p[e].y);
    if (length > longest) longest = length, a = e, b = next;
  }
  const double doubled =
      std::fabs((p[1].x - p[0].x) * (p[2].y - p[0].y) - (p[1].y - p[0].y) * (p[2].x - p[0].x));
  if (longest == 0) return true;  // nothing to be seen of it
  if (doubled >= kProfile * longest) return false;
  const float light = light_on(corners);
  draw_line(p[a], p[b], light * colours[a], light * colours[b], kProfile);
  return true;
}

void Panel::draw_line(const Projected& a, const Projected& b, Rgb colour_a, Rgb colour_b, double width) {
  const double length = std::hypot(b.x - a.x, b.y - a.y);
  if (length == 0) return;
  const double across_x = -(b.y - a.y) / length * width / 2;
  const double across_y = (b.x - a.x) / length * width / 2;
  const ScreenPoint a0{a.x - across_x, a.y - across_y}, a1{a.x + across_x, a.y + across_y};
  const ScreenPoint b0{b.x - across_x, b.y - across_y}, b1{b.x + across_x, b.y + across_y};
  // t: the share of the way from a to b.
  const auto paint = [&](int x, int y, double t) {
    const auto depth = static_cast<float>((1 - t) * a.depth + t * b.depth);
    cover(at(x, y), depth, mix(colour_a, colour_b, static_cast<float>(t)));
  };
  for_each_sample({a0, b0, b1}, columns_, rows_,
                  [&](int x, int y, double, double w1, double w2) { paint(x, y, w1 + w2); });
  for_each_sample({a0, b1, a1}, columns_, rows_,
                  [&](int x, int y, double, double w1, double) { paint(x, y, w1); });
}

void Panel::draw_curves(const std::vector<Vec3>& points, const std::vector<core::Segment>& segments,
                        const std::vector<Rgb>& colours, double width) {
  for (const auto& [a, b] : segments) {
    draw_line(project(points[a]), project(points[b]), kCurveLight * colours[a], kCurveLight * colours[b],
              kSamples * width);
    // Round joints; also what is seen from its end.  As flat as the lines: balls would look like beads.
    for (const std::uint32_t end : {a, b}) draw_disc(points[end], kCurveLight * colours[end], width / 2);
  }
}

template <class Paint>
void Panel::draw_smooth(const core::Mesh& mesh, const std::vector<Vec3>& normals, std::size_t triangle,
                        const Paint& paint) {
  std::array<Projected, 3> p{};
  for (std::size_t c = 0; c < 3; ++c) p[c] = project(mesh.points[mesh.triangles[triangle][c]]);
  const std::array<ScreenPoint, 3> corners = {{{p[0].x, p[0].y}, {p[1].x, p[1].y}, {p[2].x, p[2].y}}};
  const Vec3* n = &normals[3 * triangle];
  for_each_sample(corners, columns_, rows_, [&](int x, int y, double w0, double w1, double w2) {
    paint(x, y, static_cast<float>((w0 * p[0].depth + w1 * p[1].depth) + w2 * p[2].depth),
          [&] { return direction_of((w0 * n[0] + w1 * n[1]) + w2 * n[2]); });
  });
}

void Panel::draw_surface(const core::Mesh& mesh, const std::vector<Vec3>& normals, const Glass& glass) {
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    draw_smooth(mesh, normals, t, [&](int x, int y, float depth, const auto& normal_at) {
      const Vec3 normal = normal_at();
      double facing = core::dot(normal, view_.toward);
      const double side = facing < 0 ? -1 : 1;
      facing *= side;
      const double light =
          lambert(side * core::dot(normal, view_.right), side * core::dot(normal, view_.up), facing);
      // Clear where it faces the viewer, denser towards the outline.
      const double aside = std::max(0.0, 1 - facing);
      const float opacity = clamp01(glass.clear + glass.rim * aside * aside * std::sqrt(aside));
      Sample& sample = at(x, y);
      Layers& layers = sample.covered && depth > sample.depth ? sample.front : sample.back;
      layers.add(opacity, mix(glass.dark, glass.light, clamp01(light)));
    });
  }
}

void Panel::draw_shell(const core::Mesh& mesh, const std::vector<Vec3>& normals,
                       const std::vector<Rgb>& colours, float opacity) {
  shell_.resize(samples_.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    draw_smooth(mesh, normals, t, [&](int x, int y, float depth, const auto& normal_at) {
      ShellSample& sample = shell_[index_of(x, y)];
      if (sample.opacity > 0 && depth <= sample.depth) return;
      const Vec3 normal = normal_at();
      const double light = lambert(core::dot(normal, view_.right), core::dot(normal, view_.up),
                                   std::fabs(core::dot(normal, view_.toward)));
      const auto shade = static_cast<float>(kSheetShade + (1 - kSheetShade) * light);
      sample = {depth, shade * colours[t], opacity};
    });
  }
}

Image Panel::resolve(Rgb background) const {
  Image image(columns_ / kSamples, (rows_.end - rows_.first) / kSamples);
  constexpr float kShare = 1.0f / (kSamples * kSamples);
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      Rgb sum;
      for (int s = 0; s < kSamples * kSamples; ++s) {
        const std::size_t row = std::size_t(y * kSamples + s / kSamples);
        const std::size_t i = row * std::size_t(columns_) + std::size_t(x * kSamples + s % kSamples);
        const Sample& sample = samples_[i];
        const Rgb behind = sample.covered ? sample.solid : sample.back.over(background);
        Rgb seen = sample.front.over(behind);
        if (!shell_.empty()) seen = mix(seen, shell_[i].colour, shell_[i].opacity);
        sum = sum + seen;
      }
      image.at(x, y) = kShare * sum;
    }
  }
  return image;
}

std::vector<Vec3> corner_normals(const core::Mesh& mesh) {
  std::vector<Vec3> area(mesh.triangles.size());  // normal, length = twice the area
  std::vector<std::vector<std::uint32_t>> around(mesh.points.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const core::Triangle& corners = mesh.triangles[t];
    const Vec3& a = mesh.points[corners[0]];
    area[t] = core::cross(mesh.points[corners[1]] - a, mesh.points[corners[2]] - a);
    for (const std::uint32_t v : corners) around[v].push_back(static_cast<std::uint32_t>(t));
  }
  std::vector<Vec3> normals(3 * mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3 own = unit(area[t]);
    for (std::size_t c = 0; c < 3; ++c) {
      Vec3 sum = area[t];
      for (const std::uint32_t other : around[mesh.triangles[t][c]]) {
        if (other != t && core::dot(own, unit(area[other])) > kCreaseCosine) sum = sum + area[other];
      }
      normals[3 * t + c] = unit(sum);
    }
  }
  return normals;
}

}  // namespace affskel::client
