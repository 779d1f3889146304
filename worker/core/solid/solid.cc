#include "core/solid/solid.h"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <optional>

#include "base/number_text.h"
#include "core/base/double_sum.h"
#include "core/base/error.h"
#include "core/mesh/box.h"
#include "core/mesh/coincident_points.h"
#include "core/mesh/mesh_topology.h"
#include "core/mesh/unused_points.h"
#include "core/solid/shells.h"
#include "core/solid/specks.h"
#include "core/spatial/self_intersection.h"

namespace affskel::core {
namespace {

class SolidBuilder {
 public:
  // @param source the triangles of the mesh to use, ascending.
  SolidBuilder(const Mesh& mesh, std::vector<std::uint32_t> source, const SolidOptions& options,
               const std::vector<std::uint32_t>& vertex_line, const std::vector<std::uint32_t>& triangle_line)
      : options_(options), input_(mesh), vertex_line_(vertex_line), triangle_line_(triangle_line) {
    solid_.mesh.points = mesh.points;
    solid_.mesh.triangles.reserve(source.size());
    for (const std::uint32_t t : source) solid_.mesh.triangles.push_back(mesh.triangles[t]);
    triangle_source_ = std::move(source);
  }

  Solid run() {
    if (solid_.mesh.triangles.empty()) {
      refuse(solid_.mesh.points.empty() ? "the mesh has no triangles"
                                        : "there are points and no triangles; affskel-client repair --repair "
                                          "wrap lays a surface through them");
    }
    check_points();
    drop_lines();
    drop_unused_vertices();
    throw_if_stopped(options_.context);
    const TrianglePlace where = [this](std::uint32_t t) { return place(t); };
    HalfEdges mates;
    if (!find_mates_if_closed(solid_.mesh, options_.threads, mates)) {
      if (!every_edge_is_shared(solid_.mesh)) weld();
      mates = find_mates(solid_.mesh, where, [this](std::uint32_t h) { return edge_place(h); });
    }
    throw_if_stopped(options_.context);
    make_orientation_agree(mates, where);
    note_split(split_pinched_vertices(solid_.mesh, mates));
    throw_if_stopped(options_.context);
    normalise();
    count_degenerate();
    find_shells(mates, options_, solid_);
    throw_if_stopped(options_.context);
    const std::vector<double> volumes = scaled_volumes();
    // Before surfaces are turned, for the orientation of specks may be rounding.
    const std::vector<std::uint8_t> specks = find_specks(solid_, volumes);
    if (std::count(specks.begin(), specks.end(), 1) > 0) return without(specks);
    face_outward();
    set_volumes(volumes);
    if (options_.check_self_intersections) look_for_self_intersections();
    return std::move(solid_);
  }

 private:
  std::string place(std::uint32_t t) const {
    const std::uint32_t source = triangle_source_[t];
    std::string text = "triangle " + std::to_string(source);
    if (source < triangle_line_.size()) text += " (line " + std::to_string(triangle_line_[source]) + ")";
    return text;
  }

  // Before triangles are turned over: a corner is then still the input's.
  std::string edge_place(std::uint32_t half_edge) const {
    const Triangle& corners = input_.triangles[triangle_source_[half_edge / 3]];
    const auto [low, high] = std::minmax(corners[half_edge % 3], corners[(half_edge + 1) % 3]);
    return "vertices " + std::to_string(low) + " and " + std::to_string(high);
  }

  void note(MeshNote::Severity severity, const char* code, const std::string& message) {
    solid_.notes.push_back({severity, code, message});
  }

  // Notes a repair; refuses the mesh when repair is off.
  void repaired(const char* code, const std::string& message) {
    if (!options_.repair) refuse(message + " (repair is off)");
    note(MeshNote::Severity::kRepaired, code, message);
  }

  void check_points() const {
    const Mesh& mesh = solid_.mesh;
    for (std::size_t v = 0; v < mesh.points.size(); ++v) {
      const Vec3& p = mesh.points[v];
      if (is_finite(p)) continue;
      refuse("vertex " + std::to_string(v) + " has a coordinate that is not finite",
             v < vertex_line_.size() ? vertex_line_[v] : 0);
    }
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      const Triangle& c = mesh.triangles[t];
      for (std::uint32_t v : c) {
        if (v >= mesh.points.size())
          refuse(place(t) + " uses vertex " + std::to_string(v) + ", which is missing");
      }
    }
  }

  // Triangles that name a vertex twice: without them, what was closed is closed.
  void drop_lines() {
    const std::vector<Triangle>& triangles = solid_.mesh.triangles;
    const auto first = std::find_if(triangles.begin(), triangles.end(), is_collapsed);
    if (first == triangles.end()) return;
    const std::string where = place(static_cast<std::uint32_t>(first - triangles.begin()));
    const std::size_t dropped = drop_collapsed();
    repaired("degenerate-triangles", "left out " + base::counted(dropped, "triangle") +
                                         " with the same vertex at two corners, the first: " + where);
  }

  void drop_unused_vertices() {
    const std::vector<std::uint32_t> unused = drop_unused_points(solid_.mesh);
    if (unused.empty() || again_) return;
    std::string message = "left out " + base::counted(unused.size(), "vertex", "vertices") +
                          " without a face, the first: vertex " + std::to_string(unused.front());
    if (unused.front() < vertex_line_.size()) {
      message += " (line " + std::to_string(vertex_line_[unused.front()]) + ")";
    }
    repaired("unused-vertices", message);
  }

  void weld() {
    Mesh& mesh = solid_.mesh;
    const std::vector<std::uint32_t> first = first_coincident_point(mesh.points);
    std::uint64_t merged = 0;
    for (std::size_t v = 0; v < first.size(); ++v) merged += first[v] != v;
    if (merged == 0) return;
    repaired("welded",
             "joined " + base::counted(merged, "vertex", "vertices") + " with another one at the same place");
    for (Triangle& t : mesh.triangles) {
      for (std::uint32_t& v : t) v = first[v];
    }
    if (const std::size_t dropped = drop_collapsed(); dropped != 0) {
      note(MeshNote::Severity::kRepaired, "degenerate-triangles",
           "left out " + base::counted(dropped, "triangle") + " with two corners in one place");
    }
    drop_unused_points(mesh);
  }

  // Returns how many there were.
  std::size_t drop_collapsed() {
    Mesh& mesh = solid_.mesh;
    std::size_t kept = 0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      if (is_collapsed(mesh.triangles[t])) continue;
      triangle_source_[kept] = triangle_source_[t];
      mesh.triangles[kept++] = mesh.triangles[t];
    }
    const std::size_t dropped = mesh.triangles.size() - kept;
    mesh.triangles.resize(kept);
    triangle_source_.resize(kept);
    if (kept == 0) refuse("the mesh bounds no volume: all its triangles collapse to points or lines");
    return dropped;
  }

  void make_orientation_agree(HalfEdges& mates, const TrianglePlace& where) {
    const std::vector<std::uint32_t> turned = orient_consistently(solid_.mesh, mates, where);
    if (turned.empty()) return;
    repaired("reoriented", "turned over " + base::counted(turned.size(), "triangle") +
                               " that faced another way than the neighbours, the first: " + place(turned[0]));
  }

  void note_split(std::uint32_t added) {
    if (added == 0) return;
    repaired("split-vertices", base::counted(added, "vertex", "vertices") +
                                   " where surfaces merely touch doubled, so that each has its own");
  }

  void normalise() {
    Mesh& mesh = solid_.mesh;
    const Box box = box_of(mesh.points);
    const double side = box.longest_side();
    if (side == 0) refuse("the mesh bounds no volume: all its vertices are in one place");
    if (!std::isfinite(side)) refuse("the mesh is too large: its extent is not a double");
    int exponent = 0;
    if (std::frexp(side, &exponent) == 0.5) --exponent;
    solid_.exponent = exponent;
    solid_.bbox_min = box.low;
    solid_.bbox_max = box.high;
    solid_.centre = box.low + 0.5 * box.sides();
    for (Vec3& p : mesh.points) {
      p = p - solid_.centre;
      p = {std::ldexp(p.x, -exponent), std::ldexp(p.y, -exponent), std::ldexp(p.z, -exponent)};
    }
  }

  void count_degenerate() {
    const Mesh& mesh = solid_.mesh;
    std::uint64_t count = 0;
    std::uint32_t first = 0;
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      if (twice_area(mesh, mesh.triangles[t]) == Vec3{} && count++ == 0) first = t;
    }
    if (count == 0) return;
    note(MeshNote::Severity::kWarning, "degenerate-triangles",
         base::counted(count, "triangle") +
             " without area, which give no direction, the first: " + place(first));
  }

  // Per solid, its cavities subtracted; whichever way the surfaces face.
  std::vector<double> scaled_volumes() const {
    std::vector<DoubleSum> sums(solid_.solid_volume.size());
    for (const Shell& shell : solid_.shells) {
      sums[shell.solid].add(shell.cavity ? -std::abs(shell.volume) : std::abs(shell.volume));
    }
    std::vector<double> volumes;
    for (const DoubleSum& sum : sums) volumes.push_back(sum.value());
    return volumes;
  }

  // Turns shells so that cavities have negative volume, the others positive.
  void face_outward() {
    std::vector<std::uint8_t> wrong;
    for (const Shell& shell : solid_.shells) wrong.push_back((shell.volume < 0) != shell.cavity ? 1 : 0);
    const auto number = static_cast<std::uint32_t>(std::count(wrong.begin(), wrong.end(), 1));
    if (number != 0) turn_shells(wrong, number);
  }

  void turn_shells(const std::vector<std::uint8_t>& wrong, std::uint32_t number) {
    std::array<std::optional<std::uint32_t>, 2> first;  // by whether it is a cavity's
    for (std::uint32_t t = 0; t < solid_.mesh.triangles.size(); ++t) {
      const std::uint32_t shell = solid_.triangle_shell[t];
      if (wrong[shell] == 0) continue;
      std::swap(solid_.mesh.triangles[t][1], solid_.mesh.triangles[t][2]);
      if (auto& at = first[solid_.shells[shell].cavity ? 1 : 0]; !at) at = t;
    }
    std::uint32_t cavities = 0;
    for (std::size_t s = 0; s < wrong.size(); ++s) {
      if (wrong[s] == 0) continue;
      solid_.shells[s].volume = -solid_.shells[s].volume;
      if (solid_.shells[s].cavity) ++cavities;
    }
    const std::string of_all = " of " + base::counted(wrong.size(), "surface");
    if (first[0])
      repaired("turned-out", std::to_string(number - cavities) + of_all +
                                 " faced inward and turned, the first at " + place(*first[0]));
    if (first[1])
      repaired("turned-cavities",
               std::to_string(cavities) + of_all +
                   " inside of others taken for cavities, though facing outward, the first at " +
                   place(*first[1]));
  }

  // The solid of the input without these specks.  Built from the beginning, because the box may change, and
  // with it all scaled coordinates.
  Solid without(const std::vector<std::uint8_t>& specks) {
    std::vector<std::uint32_t> kept, left_out;
    for (std::uint32_t t = 0; t < solid_.mesh.triangles.size(); ++t) {
      const bool speck = specks[solid_.solid_of(t)] != 0;
      (speck ? left_out : kept).push_back(t);
    }
    note_specks(specks, left_out);
    for (std::uint32_t& t : kept) t = triangle_source_[t];
    SolidBuilder rest(input_, std::move(kept), options_, vertex_line_, triangle_line_);
    rest.again_ = true;
    // Keeps the notes about triangles and vertices that are not in the new input.
    for (const MeshNote& known : solid_.notes) {
      const bool collapsed =
          known.code == "degenerate-triangles" && known.severity == MeshNote::Severity::kRepaired;
      if (collapsed || known.code == "unused-vertices" || known.code == "specks")
        rest.solid_.notes.push_back(known);
    }
    solid_ = {};
    return rest.run();
  }

  void note_specks(const std::vector<std::uint8_t>& specks, const std::vector<std::uint32_t>& triangles) {
    const auto count = std::count(specks.begin(), specks.end(), 1);
    const std::uint32_t solid = solid_.solid_of(triangles.front());
    const double volume = solid_sizes(solid_)[solid].volume * std::ldexp(1.0, 3 * solid_.exponent);
    const std::string message = std::to_string(count) + " of " + std::to_string(specks.size()) + " solids (" +
                                std::to_string(triangles.size()) +
                                " triangles) bound too little volume beside the mesh's size to tell from "
                                "rounding; the first, of volume " +
                                base::rounded(volume, 3) + ", begins with " + place(triangles.front());
    if (!options_.repair) refuse(message + " (repair is off)");
    note(MeshNote::Severity::kWarning, "specks", message + "; left out");
  }

  void set_volumes(const std::vector<double>& volumes) {
    const double unit = std::ldexp(1.0, 3 * solid_.exponent);
    for (std::size_t i = 0; i < volumes.size(); ++i) {
      if (!(volumes[i] > kMinScaledVolume)) refuse_volume(i, volumes[i] * unit);
      solid_.solid_volume[i] = volumes[i] * unit;
    }
    DoubleSum total;
    for (const Shell& shell : solid_.shells) total.add(shell.volume);
    for (Shell& shell : solid_.shells) shell.volume *= unit;
    solid_.volume = total.value() * unit;
    // E of a point goes down to 1e-20 v0 and less; keep such values away from the subnormals.
    if (!std::isfinite(solid_.volume) || solid_.volume < 1e30 * std::numeric_limits<double>::min()) {
      refuse("the mesh is too " + std::string(std::isfinite(solid_.volume) ? "small" : "large") +
             ": its volume is " + base::to_text(solid_.volume) +
             ", which leaves no room for that of its parts in double precision; change the unit of length");
    }
  }

  [[noreturn]] void refuse_volume(std::size_t solid, double volume) const {
    const std::string which =
        "solid " + std::to_string(solid) + " of " + std::to_string(solid_.solid_volume.size());
    const SolidSize size = solid_sizes(solid_)[solid];
    if (size.box.longest_side() < kMinScaledSide) {
      refuse("the solids lie too far apart to be computed together: " + which + ", which begins with " +
             place(size.first_triangle) + ", is " +
             base::rounded(size.box.longest_side() * solid_.scale(), 3) + " long, the whole mesh " +
             base::rounded(Box{solid_.bbox_min, solid_.bbox_max}.longest_side(), 3) +
             "; take them one by one");
    }
    if (std::isnan(volume))
      refuse("the mesh is too large or too thin: " + which + " has a volume out of range");
    refuse("the mesh bounds no volume: " + which + " has volume " + base::to_text(volume) +
           (volume > 0 ? ", too little beside the mesh's size to tell from rounding" : ""));
  }

  void look_for_self_intersections() {
    // Folded noise has a few crossings per triangle.  More could fill the memory, and would tell nothing new.
    const SelfIntersectionOptions options{32 * solid_.mesh.triangles.size(), options_.threads,
                                          options_.context};
    const auto pairs = self_intersections(solid_.mesh, options);
    if (pairs.empty()) return;
    solid_.self_intersecting = true;
    StopCheck stop(options_.context);
    for (const auto& [i, j] : pairs) {
      stop.did(kOperationsPerPair);
      if (solid_.triangle_shell[i] != solid_.triangle_shell[j]) solid_.surfaces_meet = true;
      if (pass_through(solid_.mesh, i, j)) solid_.crossings.emplace_back(i, j);
    }
    if (const auto copies = copied_shells(solid_); !copies.empty()) {
      note(MeshNote::Severity::kWarning, "copies",
           base::counted(copies.size(), "surface") + (copies.size() == 1 ? " lies" : " lie") +
               " where another lies, the first: surface " + std::to_string(copies[0].second) +
               " is a copy of surface " + std::to_string(copies[0].first) + "; what they bound counts twice");
    }
    const std::string count = pairs.size() < options.max_pairs ? std::to_string(pairs.size())
                                                               : "at least " + std::to_string(pairs.size());
    note(MeshNote::Severity::kWarning, "self-intersecting",
         count + " pairs of triangles cross or touch each other, the first: " + place(pairs[0].first) +
             " and " + place(pairs[0].second) +
             "; overlaps count twice in volumes, and E is only approximate near them");
  }

  static constexpr std::uint64_t kOperationsPerPair = 128;

  SolidOptions options_;
  const Mesh& input_;
  bool again_ = false;  // built again, without specks
  const std::vector<std::uint32_t>& vertex_line_;
  const std::vector<std::uint32_t>& triangle_line_;
  std::vector<std::uint32_t> triangle_source_;  // index in the input, per triangle kept
  Solid solid_;
};

}  // namespace

Solid make_solid(const Mesh& mesh, const SolidOptions& options, const std::vector<std::uint32_t>& vertex_line,
                 const std::vector<std::uint32_t>& triangle_line) {
  std::vector<std::uint32_t> all(mesh.triangles.size());
  std::iota(all.begin(), all.end(), 0U);
  return SolidBuilder(mesh, std::move(all), options, vertex_line, triangle_line).run();
}

DisjointSets joined_solids(const Solid& solid) {
  DisjointSets sets(solid.solid_volume.size());
  for (const auto& [a, b] : solid.crossings) sets.unite(solid.solid_of(a), solid.solid_of(b));
  return sets;
}

}  // namespace affskel::core
