#include "client/render/scene.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "client/base/error.h"
#include "client/base/spots.h"
#include "client/render/arrangement.h"
#include "client/render/labels.h"
#include "client/render/legend.h"
#include "client/render/panel.h"
#include "client/render/stroke_text.h"
#include "core/mesh/box.h"

namespace affskel::client {
namespace {

using core::Vec3;

constexpr double kPartOfCell = 0.42;  // half the size of a point's ball: balls nearly touch
constexpr int kMinWidth = 200, kMaxWidth = 8000;
constexpr std::size_t kMaxCameras = 6;
constexpr double kTallest = 1.25;  // the views' height by the picture's width: a slim body stays on a screen
// Of the most that a view shows of the body's box: one that shows less is of an edge or an end.
constexpr double kTelling = 1.0 / 3;
constexpr Rgb kDark{0.08f, 0.09f, 0.12f};

// One view, and how large the body is in it.
struct Shown {
  std::string name;
  View view;
  Vec3 centre;       // shown in the middle
  double width = 0;  // mesh units
  double height = 0;
};

// With the axis that points at the viewer, where there is one.
std::string view_name(const std::string& camera, const View& view) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const bool minus : {false, true}) {
      const core::AxisDirection direction{axis, minus};
      if (core::dot(direction.vector(), view.toward) == 1)
        return camera + " (" + direction_text(direction) + ")";
    }
  }
  return camera;
}

Shown shown_by(const Camera& camera, const RenderInput& input) {
  Shown shown{"", view_of(camera, input.stance), {}, 0, 0};
  shown.name = view_name(camera.name, shown.view);
  const core::Matrix3 axes{shown.view.right, shown.view.up, shown.view.toward};
  const core::Box box = core::box_of(input.mesh.points, axes);
  shown.centre = axes * box.middle();
  shown.width = box.sides().x;
  shown.height = box.sides().y;
  return shown;
}

// The first view that is no look at the edge of a plate or the end of a rod.
Shown telling(const std::vector<Shown>& views) {
  double most = 0;
  for (const Shown& shown : views) most = std::max(most, shown.width * shown.height);
  return *std::find_if(views.begin(), views.end(),
                       [&](const Shown& shown) { return shown.width * shown.height >= kTelling * most; });
}

// Everything in pixels.
struct Layout {
  double text = 0;  // height of a capital letter
  int margin = 0;
  int head = 0;             // height of the strip above the views
  double label = 0;         // height of the line above a view
  Arrangement arrangement;  // of the views, then the legend
  double scale() const { return arrangement.scale; }
  int height() const { return head + static_cast<int>(std::ceil(arrangement.height)) + margin; }
  ScreenPoint place(std::size_t block) const {
    return {margin + arrangement.places[block].left, head + arrangement.places[block].top};
  }
};

// The E of the last colour.
double highest_of(const RenderInput& input) {
  double highest = 0;
  for (const double e : input.skeleton.erosion()) highest = std::max(highest, e);
  for (const double e : input.sheet.erosion()) highest = std::max(highest, e);
  return highest;
}

Layout lay_out(const std::vector<Shown>& views, const RenderOptions& options, const RenderInput& input,
               Legend& legend) {
  Layout layout;
  const int width = options.width;
  layout.text = std::max(6.0, width / 110.0);
  layout.margin = std::max(4, width / 50);
  layout.head = options.bare ? 0 : static_cast<int>(4 * layout.text);
  layout.label = options.bare ? 0 : 2.4 * layout.text;
  legend.text = layout.text;
  legend.scale = input.painted ? input.painted->scale : erosion_scale(highest_of(input), input.volume);
  if (input.painted) {
    legend.title = input.painted->title;
    legend.rows = input.painted->rows;
  }
  for (const DefectMarks& marks : input.marks) {
    legend.title = "Defects";
    legend.rows.push_back(marks.what);
  }
  legend.level = input.eroded.corners().empty() ? "" : input.level;
  std::vector<Block> blocks;
  for (const Shown& shown : views)
    blocks.push_back({shown.width, shown.height, 0.5 * layout.margin, layout.label + 0.5 * layout.margin});
  if (!options.bare) blocks.push_back({0, 0, legend.width(), legend.height() + 0.5 * layout.margin});
  layout.arrangement = arrange(blocks, width - 2.0 * layout.margin, kTallest * width, layout.margin);
  return layout;
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
  const double share = std::min(kPartOfCell, layout.text / 2 / (whole * layout.scale()));
  std::array<Vec3, 3> half_axes = input.cell;
  for (Vec3& axis : half_axes) axis = share * axis;
  for (int p = 0; p < input.skeleton.point_size(); ++p) {
    const Vec3 at{input.skeleton.xyz(3 * p), input.skeleton.xyz(3 * p + 1), input.skeleton.xyz(3 * p + 2)};
    const Ball ball{at, viridis(colour_position(input.skeleton.erosion(p), highest))};
    panel.draw_ball(ball, smallest);
    panel.draw_ellipsoid(ball, half_axes);
  }
}

core::Mesh mesh_of(const v1::TriangleMesh& surface) {
  core::Mesh mesh;
  for (int v = 0; v < surface.xyz_size() / 3; ++v)
    mesh.points.push_back({surface.xyz(3 * v), surface.xyz(3 * v + 1), surface.xyz(3 * v + 2)});
  for (int t = 0; t < surface.corners_size() / 3; ++t) {
    mesh.triangles.push_back(
        {surface.corners(3 * t), surface.corners(3 * t + 1), surface.corners(3 * t + 2)});
  }
  return mesh;
}

// What all views show alike, made once.
struct Scene {
  double highest = 0;        // the E of the last colour
  core::Mesh sheet;          // no triangles: none
  std::vector<Rgb> colours;  // of its vertices
  std::vector<core::Segment> curves;
  std::vector<std::uint32_t> spots;  // vertices of what is no wider than a curve
  double curve_width = 0;            // pixels
  core::Mesh eroded;
  std::vector<Vec3> eroded_normals, body_normals;  // by triangle and corner
};

// Of the sheet's vertices.  Through a painted body it shines as what is behind it does not.
std::vector<Rgb> colours_of(const RenderInput& input, double highest, Rgb background) {
  const Rgb ink = is_dark(background) ? kWhite : kInk;
  if (input.painted) return std::vector<Rgb>(static_cast<std::size_t>(input.sheet.erosion_size()), ink);
  std::vector<Rgb> colours;
  for (const double e : input.sheet.erosion()) colours.push_back(viridis(colour_position(e, highest)));
  return colours;
}

Scene make_scene(const RenderInput& input, const RenderOptions& options, const Layout& layout) {
  Scene scene;
  scene.highest = highest_of(input);
  scene.sheet = mesh_of(input.sheet);
  scene.colours = colours_of(input, scene.highest, options.background);
  for (int i = 0; i < input.sheet.segments_size(); i += 2)
    scene.curves.push_back({input.sheet.segments(i), input.sheet.segments(i + 1)});
  scene.curve_width = std::max(2.0, layout.text / 5);
  scene.spots = spots_of(input.sheet, scene.curve_width / layout.scale());
  scene.eroded = mesh_of(input.eroded);
  scene.eroded_normals = corner_normals(scene.eroded);
  if (input.painted) {
    scene.body_normals = corner_normals(input.painted->mesh);
  } else if (options.mesh) {
    scene.body_normals = corner_normals(input.mesh);
  }
  return scene;
}

void draw_sheet(const Scene& scene, Panel& panel) {
  panel.draw_sheet(scene.sheet, scene.colours);
  panel.draw_curves(scene.sheet.points, scene.curves, scene.colours, scene.curve_width);
  for (const std::uint32_t v : scene.spots)
    panel.draw_ball({scene.sheet.points[v], scene.colours[v]}, scene.curve_width);
}

void draw_solids(const RenderInput& input, const RenderOptions& options, const Scene& scene, Panel& panel) {
  if (!scene.eroded.triangles.empty()) panel.draw_surface(scene.eroded, scene.eroded_normals, kErodedGlass);
  if (input.painted) {
    panel.draw_shell(input.painted->mesh, scene.body_normals, input.painted->colours, input.painted->opacity);
  } else if (options.mesh) {
    panel.draw_surface(input.mesh, scene.body_normals,
                       is_dark(options.background) ? kGlassOnDark : kGlassOnLight);
  }
}

// An edge that is short on the picture is a spot.
void draw_marks(const RenderInput& input, const Layout& layout, Panel& panel) {
  const double width = std::max(2.0, layout.text / 4);
  for (const DefectMarks& marks : input.marks) {
    const std::vector<Rgb> colours(input.mesh.points.size(), marks.what.colour);
    panel.draw_curves(input.mesh.points, marks.edges, colours, width);
    for (const auto& [a, b] : marks.edges)
      panel.draw_ball({0.5 * (input.mesh.points[a] + input.mesh.points[b]), marks.what.colour}, 0.7 * width);
  }
}

// One view with its name above it.
void draw_view(Image& image, const RenderInput& input, const RenderOptions& options, const Layout& layout,
               const Scene& scene, const Shown& shown, std::size_t which) {
  const int width = static_cast<int>(std::ceil(layout.scale() * shown.width)) + layout.margin / 2;
  const int height = static_cast<int>(std::ceil(layout.scale() * shown.height)) + layout.margin / 2;
  const ScreenPoint at = layout.place(which);
  Panel panel = Panel::banded(width, height, shown.view, shown.centre, layout.scale());
  do {
    draw_points(input, layout, scene.highest, panel);
    draw_sheet(scene, panel);
    draw_marks(input, layout, panel);
    draw_solids(input, options, scene, panel);
    paste(image, panel.resolve(options.background), static_cast<int>(at.x),
          static_cast<int>(at.y + layout.label) + panel.top());
  } while (panel.next_band());
  if (options.bare) return;
  if (input.painted)
    draw_labels(*input.painted, panel, {std::floor(at.x), std::floor(at.y + layout.label)}, 0.8 * layout.text,
                image);
  // A name that is longer than the body is wide reaches into the gaps beside it, or is written smaller.
  const double room = width + layout.margin, needed = text_width(shown.name, layout.text);
  const double size = layout.text * std::min(1.0, room / needed);
  draw_text(image, {at.x + (width - std::min(room, needed)) / 2, at.y + layout.text}, shown.name, size,
            ink_on(options.background).faint);
}

void draw_title(Image& image, const Layout& layout, const std::string& title, Rgb ink) {
  double size = 1.25 * layout.text;
  const double room = image.width() - 2.0 * layout.margin;
  if (const double needed = text_width(title, size); needed > room) size *= room / needed;
  draw_text(image, {double(layout.margin), 2.3 * layout.text}, title, size, ink);
}

void check(const RenderInput& input, const RenderOptions& options) {
  if (options.width < kMinWidth || options.width > kMaxWidth) {
    throw ClientError(ExitCode::kUsage, "the width must be " + std::to_string(kMinWidth) + " .. " +
                                            std::to_string(kMaxWidth) + " pixels");
  }
  if (options.cameras.empty() || options.cameras.size() > kMaxCameras)
    throw ClientError(ExitCode::kUsage, "a picture has 1 to " + std::to_string(kMaxCameras) + " cameras");
  if (input.mesh.triangles.empty())
    throw ClientError(ExitCode::kBadInput, "the mesh has no triangles to draw");
}

}  // namespace

Image render_scene(const RenderInput& input, const RenderOptions& options) {
  check(input, options);
  std::vector<Shown> views;
  for (const Camera& camera : options.cameras) views.push_back(shown_by(camera, input));
  if (options.bare) views = {telling(views)};
  Legend legend;
  legend.ink = ink_on(options.background);
  const Layout layout = lay_out(views, options, input, legend);
  Image image(options.width, layout.height(), options.background);
  const Scene scene = make_scene(input, options, layout);
  for (std::size_t v = 0; v < views.size(); ++v) draw_view(image, input, options, layout, scene, views[v], v);
  if (options.bare) return image;
  draw_title(image, layout, input.title, legend.ink.strong);
  draw_legend(image, legend, layout.place(views.size()), layout.scale());
  return image;
}

Rgb parse_background(const std::string& text) {
  if (text == "white") return kWhite;
  if (text == "black") return {0, 0, 0};
  if (text == "dark") return kDark;
  const bool digits =
      text.starts_with('#') && text.find_first_not_of("0123456789abcdefABCDEF", 1) == std::string::npos;
  if (!digits || (text.size() != 4 && text.size() != 7)) {
    throw ClientError(ExitCode::kUsage,
                      "background '" + text + "': white, black, dark, #RGB or #RRGGBB is needed");
  }
  const std::size_t each = text.size() / 3;
  const auto part = [&](std::size_t c) {
    const std::string component = text.substr(1 + c * each, each);
    return static_cast<float>(std::stoi(each == 1 ? component + component : component, nullptr, 16)) / 255;
  };
  return {part(0), part(1), part(2)};
}

}  // namespace affskel::client
