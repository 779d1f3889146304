#include "client/render/labels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "client/render/stroke_text.h"

namespace affskel::client {
namespace {

constexpr double kHalo = 4;  // strokes: round black letters, to be read on dark parts and backgrounds

// What the viewer sees first where a place is seen; none beside the body.
std::optional<Rgb> colour_seen(const PaintedBody& body, const std::vector<PanelPlace>& points,
                               const PanelPlace& at) {
  std::optional<Rgb> seen;
  double nearest = 0;
  for (std::size_t t = 0; t < body.mesh.triangles.size(); ++t) {
    const auto& [a, b, c] = body.mesh.triangles[t];
    const PanelPlace &p = points[a], &q = points[b], &r = points[c];
    // Twice the areas of the triangles that the place makes with the sides.
    const auto area = [&](const PanelPlace& from, const PanelPlace& to) {
      return (to.x - from.x) * (at.y - from.y) - (to.y - from.y) * (at.x - from.x);
    };
    const std::array<double, 3> across = {area(q, r), area(r, p), area(p, q)};
    const auto [least, greatest] = std::minmax_element(across.begin(), across.end());
    if (*least < 0 && *greatest > 0) continue;
    const double whole = across[0] + across[1] + across[2];
    if (whole == 0) continue;
    const double depth = (across[0] * p.depth + across[1] * q.depth + across[2] * r.depth) / whole;
    if (seen && depth <= nearest) continue;
    nearest = depth;
    seen = body.colours[t];
  }
  return seen;
}

}  // namespace

void draw_labels(const PaintedBody& body, const Panel& panel, ScreenPoint corner, double size, Image& image) {
  if (body.labels.empty()) return;
  struct Written {
    ScreenPoint at;
    double width;
  };
  std::vector<PanelPlace> points;
  for (const core::Vec3& point : body.mesh.points) points.push_back(panel.place(point));
  std::vector<Written> all;
  for (const Label& label : body.labels) {
    const PanelPlace place = panel.place(label.place);
    const ScreenPoint at{corner.x + place.x + 0.4 * size, corner.y + place.y + 0.5 * size};
    const double width = text_width(label.text, size);
    const bool runs_into = std::any_of(all.begin(), all.end(), [&](const Written& other) {
      return std::abs(at.y - other.at.y) < 1.4 * size && at.x < other.at.x + other.width + 0.3 * size &&
             other.at.x < at.x + width + 0.3 * size;
    });
    if (runs_into || colour_seen(body, points, place) != label.colour) continue;
    draw_text(image, at, label.text, size, kWhite, kHalo);
    draw_text(image, at, label.text, size, kInk);
    all.push_back({at, width});
  }
}

}  // namespace affskel::client
