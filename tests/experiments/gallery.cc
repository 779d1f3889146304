#include "gallery.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "client/render/stroke_text.h"

namespace affskel::experiments {
namespace {

using client::Image;
using client::Rgb;
using client::View;
using core::Vec3;

constexpr Rgb kInk{0.13f, 0.15f, 0.18f};
constexpr Rgb kFaint{0.45f, 0.48f, 0.52f};
constexpr Rgb kSurface{0.93f, 0.62f, 0.28f};
constexpr double kText = 13;    // height of a capital letter, pixels
constexpr double kMargin = 22;  // round a view, pixels
constexpr double kMaxHeight = 900;
constexpr double kCurve = 2.5;  // width of a curve, pixels

View view_of(Side side) {
  switch (side) {
    case Side::kFront:
      return {{1, 0, 0}, {0, 0, 1}, {0, -1, 0}};
    case Side::kSide:
      return {{0, 1, 0}, {0, 0, 1}, {1, 0, 0}};
    case Side::kTop:
      return {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    case Side::kOblique:
      break;
  }
  // From the front, 37 degrees to the right and 37 degrees above.
  return {{0.8, 0.6, 0}, {-0.36, 0.48, 0.8}, {0.48, -0.64, 0.6}};
}

const char* name_of(Side side) {
  constexpr const char* kNames[] = {"front", "side", "top", "oblique"};
  return kNames[static_cast<int>(side)];
}

// What a view of an exhibit spans: its right, up and toward coordinates.
struct Extent {
  Vec3 low, high;
  double width() const { return high.x - low.x; }
  double height() const { return high.y - low.y; }
};

Extent extent_of(const Exhibit& exhibit, const View& view) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Extent extent{{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};
  const std::vector<Vec3>& points = !exhibit.solid.points.empty()     ? exhibit.solid.points
                                    : !exhibit.surface.points.empty() ? exhibit.surface.points
                                                                      : exhibit.points;
  for (const Vec3& p : points) {
    const Vec3 q{core::dot(view.right, p), core::dot(view.up, p), core::dot(view.toward, p)};
    extent.low = {std::min(extent.low.x, q.x), std::min(extent.low.y, q.y), std::min(extent.low.z, q.z)};
    extent.high = {std::max(extent.high.x, q.x), std::max(extent.high.y, q.y), std::max(extent.high.z, q.z)};
  }
  return extent;
}

Vec3 centre_of(const Extent& extent, const View& view) {
  const Vec3 c = 0.5 * (extent.low + extent.high);
  return c.x * view.right + (c.y * view.up + c.z * view.toward);
}

Image draw(const Exhibit& exhibit, const View& view, const Extent& extent, double scale, int width,
           int height) {
  client::Panel panel(width, height, view, centre_of(extent, view), scale);
  double highest = 0;
  for (const double e : exhibit.erosion) highest = std::max(highest, e);
  const double radius = std::max(1.2, scale * exhibit.ball_radius);
  for (std::size_t p = 0; p < exhibit.points.size(); ++p) {
    const double t = highest > 0 ? std::cbrt(exhibit.erosion[p] / highest) : 0;
    panel.draw_ball({exhibit.points[p], client::viridis(static_cast<float>(t))}, radius);
  }
  panel.draw_sheet(exhibit.surface, std::vector<Rgb>(exhibit.surface.points.size(), kSurface));
  panel.draw_curves(exhibit.surface.points, exhibit.segments,
                    std::vector<Rgb>(exhibit.surface.points.size(), kSurface), kCurve);
  panel.draw_surface(exhibit.solid, client::corner_normals(exhibit.solid));
  return panel.resolve();
}

void paste(Image& image, const Image& part, int left, int top) {
  for (int y = 0; y < part.height(); ++y) {
    for (int x = 0; x < part.width(); ++x) {
      if (image.contains(left + x, top + y)) image.at(left + x, top + y) = part.at(x, y);
    }
  }
}

void draw_centred(Image& image, double left, double width, double baseline, const std::string& text,
                  Rgb colour) {
  const double room = width + 1.6 * kMargin;
  const double size = std::min(kText, kText * room / std::max(1.0, client::text_width(text, kText)));
  client::draw_text(image, {left + (width - client::text_width(text, size)) / 2, baseline}, text, size,
                    colour);
}

}  // namespace

Image gallery(const std::vector<Exhibit>& exhibits, const GalleryOptions& options) {
  std::vector<Extent> extents;
  double across = 0, tallest = 0;
  std::size_t lines = 0;
  for (const Exhibit& exhibit : exhibits) {
    lines = std::max(lines, exhibit.caption.size());
    for (const Side side : options.sides) {
      extents.push_back(extent_of(exhibit, view_of(side)));
      across += extents.back().width();
      tallest = std::max(tallest, extents.back().height());
    }
  }
  const double room = options.width - 2 * kMargin * static_cast<double>(extents.size());
  const double scale = std::min(room / across, kMaxHeight / tallest);
  const double spare = (room - scale * across) / static_cast<double>(extents.size());
  const int head = static_cast<int>(1.9 * kText * static_cast<double>(lines) + 2.6 * kText);
  const int height = static_cast<int>(std::ceil(scale * tallest + kMargin));
  Image image(options.width, head + height);
  double left = kMargin;
  auto extent = extents.begin();
  for (const Exhibit& exhibit : exhibits) {
    const double first = left;
    for (const Side side : options.sides) {
      const double width = scale * extent->width() + spare;
      const View view = view_of(side);
      const auto room_x = static_cast<int>(width + kMargin);
      paste(image, draw(exhibit, view, *extent, scale, room_x, height), static_cast<int>(left - kMargin / 2),
            head);
      draw_centred(image, left, width, head - 0.5 * kText, name_of(side), kFaint);
      left += width + 2 * kMargin;
      ++extent;
    }
    double baseline = 1.7 * kText;
    for (const std::string& line : exhibit.caption) {
      draw_centred(image, first, left - 2 * kMargin - first, baseline, line, kInk);
      baseline += 1.9 * kText;
    }
  }
  return image;
}

}  // namespace affskel::experiments
