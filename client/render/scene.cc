#include "client/render/scene.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/number_text.h"
#include "client/base/error.h"
#include "client/base/mesh_box.h"
#include "client/render/panel.h"
#include "client/render/stroke_text.h"

namespace affskel::client {
namespace {

using core::Vec3;

constexpr Rgb kInk{0.13f, 0.15f, 0.18f};
constexpr Rgb kFaint{0.45f, 0.48f, 0.52f};
constexpr double kPartOfCell = 0.42;  // half the size of a point's ball: balls nearly touch
constexpr int kMinWidth = 200, kMaxWidth = 8000;

struct NamedView {
  const char* name;
  View view;
};

// The z axis is up; a body faces -y.
constexpr std::array<NamedView, 3> kViews = {{
    {"front", {{1, 0, 0}, {0, 0, 1}, {0, -1, 0}}},
    {"side", {{0, 1, 0}, {0, 0, 1}, {1, 0, 0}}},
    {"top", {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}},
}};

// Everything in pixels.
struct Layout {
  double text;  // height of a capital letter
  int margin;
  int head, foot;  // heights of the strips above and below the panels
  int panel_height;
  std::array<int, 3> panel_width;
  double scale;  // pixels per mesh unit
  int height() const { return head + panel_height + foot; }
};

Layout lay_out(const Box& box, int width) {
  Layout layout{};
  layout.text = std::max(6.0, width / 110.0);
  layout.margin = std::max(4, width / 50);
  layout.head = static_cast<int>(5.2 * layout.text);
  layout.foot = static_cast<int>(6.5 * layout.text);
  const Vec3 size = box.size();
  const std::array<double, 3> widths = {size.x, size.y, size.x};
  const double total = widths[0] + widths[1] + widths[2];
  const double tallest = std::max(size.z, size.y);
  const double room = width - 4.0 * layout.margin;
  // A slim body must not make the picture endlessly high.
  layout.scale = std::min(room / total, 0.9 * width / tallest);
  layout.panel_height = static_cast<int>(std::ceil(layout.scale * tallest)) + layout.margin;
  for (std::size_t v = 0; v < 3; ++v) {
    // Spare width is shared out evenly.
    const double spare = (room - layout.scale * total) / 3;
    layout.panel_width[v] = std::max(1, static_cast<int>(layout.scale * widths[v] + spare)) + layout.margin;
  }
  return layout;
}

// The E of the last colour.
double highest_of(const RenderInput& input) {
  double highest = 0;
  for (const double e : input.skeleton.erosion()) highest = std::max(highest, e);
  for (const double e : input.sheet.erosion()) highest = std::max(highest, e);
  return highest;
}

void paste(Image& image, const Image& part, int left, int top) {
  for (int y = 0; y < part.height(); ++y) {
    for (int x = 0; x < part.width(); ++x) {
      if (image.contains(left + x, top + y)) image.at(left + x, top + y) = part.at(x, y);
    }
  }
}

void draw_points(const RenderInput& input, const Layout& layout, double highest, Panel& panel) {
  // A ball in a cubic cell, and its affine image in any other: neighbours are as near to each other along
  // every axis of the lattice.  Frames keep volumes, so that it is as large as in the mesh's own.
  const double smallest = std::max(1.0, layout.text / 9);
  const double whole =
      std::cbrt(std::fabs(core::dot(input.cell[0], core::cross(input.cell[1], input.cell[2]))));
  const double share = std::min(kPartOfCell, layout.text / 2 / (whole * layout.scale));
  std::array<Vec3, 3> half_axes = input.cell;
  for (Vec3& axis : half_axes) axis = share * axis;
  for (int p = 0; p < input.skeleton.point_size(); ++p) {
    const Vec3 at{input.skeleton.xyz(3 * p), input.skeleton.xyz(3 * p + 1), input.skeleton.xyz(3 * p + 2)};
    const Ball ball{at, viridis(colour_position(input.skeleton.erosion(p), highest))};
    panel.draw_ball(ball, smallest);
    panel.draw_ellipsoid(ball, half_axes);
  }
}

// @param curve_width pixels.
void draw_sheet(const v1::TriangleMesh& sheet, double highest, double curve_width, Panel& panel) {
  core::Mesh mesh;
  std::vector<Rgb> colours;
  for (int v = 0; v < sheet.xyz_size() / 3; ++v) {
    mesh.points.push_back({sheet.xyz(3 * v), sheet.xyz(3 * v + 1), sheet.xyz(3 * v + 2)});
    colours.push_back(viridis(colour_position(sheet.erosion(v), highest)));
  }
  for (int t = 0; t < sheet.corners_size() / 3; ++t) {
    mesh.triangles.push_back({sheet.corners(3 * t), sheet.corners(3 * t + 1), sheet.corners(3 * t + 2)});
  }
  panel.draw_sheet(mesh, colours);
  std::vector<core::Segment> segments;
  for (int i = 0; i < sheet.segments_size(); i += 2)
    segments.push_back({sheet.segments(i), sheet.segments(i + 1)});
  panel.draw_curves(mesh.points, segments, colours, curve_width);
}

Image draw_panel(const RenderInput& input, const std::vector<Vec3>& normals, const Layout& layout,
                 const Box& box, std::size_t which) {
  Panel panel(layout.panel_width[which], layout.panel_height, kViews[which].view, box.centre(), layout.scale);
  const double highest = highest_of(input);
  draw_points(input, layout, highest, panel);
  draw_sheet(input.sheet, highest, std::max(2.0, layout.text / 5), panel);
  panel.draw_surface(input.mesh, normals);
  return panel.resolve();
}

// 1, 2 or 5 times a power of ten, at most `limit`.
double round_length(double limit) {
  const double power = std::pow(10.0, std::floor(std::log10(limit)));
  for (const double factor : {5.0, 2.0}) {
    if (factor * power <= limit) return factor * power;
  }
  return power;
}

void draw_scale_bar(Image& image, const Layout& layout) {
  const double length = round_length(0.2 * image.width() / layout.scale);
  const double left = layout.margin, right = left + length * layout.scale;
  const double y = image.height() - 2.4 * layout.text, tick = 0.5 * layout.text;
  const double stroke = std::max(1.0, layout.text / 7);
  draw_stroke(image, {left, y}, {right, y}, stroke, kInk);
  draw_stroke(image, {left, y - tick}, {left, y + tick}, stroke, kInk);
  draw_stroke(image, {right, y - tick}, {right, y + tick}, stroke, kInk);
  const std::string label = base::to_text(length) + (length == 1 ? " unit" : " units");
  draw_text(image, {(left + right - text_width(label, layout.text)) / 2, y - 1.2 * layout.text}, label,
            layout.text, kInk);
}

void draw_colour_bar(Image& image, const Layout& layout, const RenderInput& input) {
  const double highest = highest_of(input);
  if (highest <= 0) return;
  const int width = image.width() * 2 / 5, left = image.width() - layout.margin - width;
  const int top = image.height() - static_cast<int>(3.6 * layout.text),
            height = static_cast<int>(1.1 * layout.text);
  for (int x = 0; x < width; ++x) {
    const Rgb colour = viridis(float(x) / float(width - 1));
    for (int y = 0; y < height; ++y) image.at(left + x, top + y) = colour;
  }
  const double unit = input.volume > 0 ? input.volume : 1;
  const std::string title = input.volume > 0 ? "erosion level E / v0" : "erosion level E";
  draw_text(image, {double(left), top - 0.8 * layout.text}, title, layout.text, kInk);
  for (int tick = 0; tick <= 4; ++tick) {
    const double t = tick / 4.0;
    const std::string label = tick == 0 ? "0" : base::rounded(t * t * t * highest / unit, 2);
    const double text = text_width(label, 0.9 * layout.text);
    const double x = left + t * (width - 1);
    const double start = std::clamp(x - text / 2, double(left), left + width - text);
    draw_stroke(image, {x, double(top + height)}, {x, top + height + 0.4 * layout.text},
                std::max(1.0, layout.text / 9), kFaint);
    draw_text(image, {start, top + height + 1.7 * layout.text}, label, 0.9 * layout.text, kInk);
  }
}

void draw_titles(Image& image, const Layout& layout, const std::string& title) {
  double size = 1.25 * layout.text;
  const double room = image.width() - 2.0 * layout.margin;
  if (const double needed = text_width(title, size); needed > room) size *= room / needed;
  draw_text(image, {double(layout.margin), 2.3 * layout.text}, title, size, kInk);
}

}  // namespace

Image render_scene(const RenderInput& input, const RenderOptions& options) {
  if (options.width < kMinWidth || options.width > kMaxWidth) {
    throw ClientError(ExitCode::kUsage, "the width must be " + std::to_string(kMinWidth) + " .. " +
                                            std::to_string(kMaxWidth) + " pixels");
  }
  if (input.mesh.triangles.empty())
    throw ClientError(ExitCode::kBadInput, "the mesh has no triangles to draw");
  const Box box = mesh_box(input.mesh);
  const Layout layout = lay_out(box, options.width);
  const std::vector<Vec3> normals = corner_normals(input.mesh);
  Image image(options.width, layout.height());
  int left = layout.margin / 2;
  for (std::size_t v = 0; v < kViews.size(); ++v) {
    paste(image, draw_panel(input, normals, layout, box, v), left, layout.head);
    const double text = text_width(kViews[v].name, layout.text);
    draw_text(image, {left + (layout.panel_width[v] - text) / 2, double(layout.head) - 0.6 * layout.text},
              kViews[v].name, layout.text, kFaint);
    left += layout.panel_width[v];
  }
  draw_titles(image, layout, input.title);
  draw_scale_bar(image, layout);
  draw_colour_bar(image, layout, input);
  return image;
}

}  // namespace affskel::client
