#include "client/files/read/mesh_defects.h"

#include <algorithm>
#include <array>
#include <tuple>

#include "core/mesh/coincident_points.h"

namespace affskel::client {
namespace {

using Corners = std::array<std::uint32_t, 3>;

struct Edge {
  std::uint32_t low, high;  // welded vertices
  std::uint32_t triangle, corner;
};

// Collects places of one kind of defect.
class Collector {
 public:
  Collector(std::string name, std::string one, std::string many, const core::OffMesh& off,
            std::size_t max_places)
      : one_(std::move(one)), many_(std::move(many)), off_(off), max_places_(max_places) {
    defect_.code = name + "s";
    std::replace(defect_.code.begin(), defect_.code.end(), ' ', '-');
    defect_.name = std::move(name);
  }

  void add_triangle(std::uint32_t triangle, const std::string& detail) {
    const core::Triangle& t = off_.mesh.triangles[triangle];
    add(triangle, detail, {{t[0], t[1]}, {t[1], t[2]}, {t[2], t[0]}});
  }

  void add_edge(const Edge& edge) {
    const core::Triangle& t = off_.mesh.triangles[edge.triangle];
    const auto [low, high] = std::minmax(t[edge.corner], t[(edge.corner + 1) % 3]);
    add(edge.triangle, ", vertices " + std::to_string(low) + " and " + std::to_string(high), {{low, high}});
  }

  void finish(std::vector<MeshDefect>& defects) {
    if (defect_.count == 0) return;
    defect_.cause = defect_.count == 1 ? one_ : many_;
    defects.push_back(std::move(defect_));
  }

 private:
  void add(std::uint32_t triangle, const std::string& detail, std::vector<core::Segment> edges) {
    if (++defect_.count > max_places_) return;
    const std::uint64_t line = triangle < off_.triangle_line.size() ? off_.triangle_line[triangle] : 0;
    defect_.places.push_back({line, triangle, detail, std::move(edges)});
  }

  MeshDefect defect_;
  std::string one_, many_;
  const core::OffMesh& off_;
  std::size_t max_places_;
};

// Welded corners; degenerate triangles are reported and left out.
std::vector<std::pair<Corners, std::uint32_t>> proper_triangles(const core::OffMesh& off,
                                                                std::size_t max_places,
                                                                std::vector<MeshDefect>& defects) {
  Collector degenerate("degenerate triangle", "triangle has two corners at one place",
                       "triangles have two corners at one place", off, max_places);
  const std::vector<std::uint32_t> first = core::first_coincident_point(off.mesh.points);
  std::vector<std::pair<Corners, std::uint32_t>> proper;
  for (std::uint32_t t = 0; t < off.mesh.triangles.size(); ++t) {
    Corners corners{};
    for (std::size_t c = 0; c < 3; ++c) corners[c] = first[off.mesh.triangles[t][c]];
    if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) {
      degenerate.add_triangle(t, "");
    } else {
      proper.emplace_back(corners, t);
    }
  }
  degenerate.finish(defects);
  return proper;
}

void find_edge_defects(const std::vector<std::pair<Corners, std::uint32_t>>& triangles,
                       const core::OffMesh& off, std::size_t max_places, std::vector<MeshDefect>& defects) {
  std::vector<Edge> edges;
  for (const auto& [corners, t] : triangles) {
    for (std::uint32_t c = 0; c < 3; ++c) {
      const auto [low, high] = std::minmax(corners[c], corners[(c + 1) % 3]);
      edges.push_back({low, high, t, c});
    }
  }
  const auto key = [](const Edge& e) { return std::tuple(e.low, e.high, e.triangle); };
  std::sort(edges.begin(), edges.end(), [&](const Edge& a, const Edge& b) { return key(a) < key(b); });
  Collector open("open edge", "edge has a triangle on one side only (a hole)",
                 "edges have a triangle on one side only (a hole)", off, max_places);
  Collector crowded("crowded edge", "edge has more than two triangles", "edges have more than two triangles",
                    off, max_places);
  for (std::size_t begin = 0, end = 0; begin < edges.size(); begin = end) {
    while (end < edges.size() && edges[end].low == edges[begin].low && edges[end].high == edges[begin].high)
      ++end;
    if (end - begin == 1) open.add_edge(edges[begin]);
    if (end - begin > 2) crowded.add_edge(edges[begin]);
  }
  open.finish(defects);
  crowded.finish(defects);
}

void find_repeated(std::vector<std::pair<Corners, std::uint32_t>> triangles, const core::OffMesh& off,
                   std::size_t max_places, std::vector<MeshDefect>& defects) {
  for (auto& entry : triangles) std::sort(entry.first.begin(), entry.first.end());
  std::sort(triangles.begin(), triangles.end());
  Collector repeated("repeated triangle", "triangle repeats another", "triangles repeat others", off,
                     max_places);
  for (std::size_t i = 1; i < triangles.size(); ++i) {
    if (triangles[i].first != triangles[i - 1].first) continue;
    repeated.add_triangle(triangles[i].second, ", like triangle " + std::to_string(triangles[i - 1].second));
  }
  repeated.finish(defects);
}

}  // namespace

std::string place_text(const DefectPlace& place) {
  return (place.line > 0 ? "line " + std::to_string(place.line) + ", " : std::string()) + "triangle " +
         std::to_string(place.triangle) + place.detail;
}

std::string defect_text(const MeshDefect& defect) {
  std::string text = std::to_string(defect.count) + " " + defect.cause;
  for (const DefectPlace& place : defect.places)
    text += (&place == &defect.places.front() ? ": " : "; ") + place_text(place);
  const std::uint64_t more = defect.count - defect.places.size();
  return more == 0 ? text : text + "; and " + std::to_string(more) + " more";
}

std::vector<MeshDefect> find_defects(const core::OffMesh& off, std::size_t max_places) {
  std::vector<MeshDefect> defects;
  const auto triangles = proper_triangles(off, max_places, defects);
  find_edge_defects(triangles, off, max_places, defects);
  find_repeated(triangles, off, max_places, defects);
  return defects;
}

}  // namespace affskel::client
