#include "core/repair/repair_mesh.h"

#include <algorithm>
#include <cmath>

#include "base/number_text.h"
#include "core/base/disjoint_sets.h"
#include "core/base/error.h"
#include "core/mesh/box.h"
#include "core/mesh/edges.h"
#include "core/mesh/unused_points.h"
#include "core/repair/cloud_surface.h"
#include "core/repair/fill_holes.h"
#include "core/repair/flat_sheet.h"
#include "core/repair/orient_soup.h"
#include "core/repair/wrap_solid.h"
#include "core/solid/surface_samples.h"
#include "core/solid/turn_as_in.h"

namespace affskel::core {
namespace {

constexpr double kLongestHole = 0.6;        // of the box's diagonal: half of a body's back, a sleeve, a neck
constexpr double kWrapDetail = 1.0 / 220;   // of the box's diagonal
constexpr double kFinestWrap = 1.0 / 2000;  // of the box's diagonal: some five million triangles, and minutes
constexpr double kSmallest = 1e-60, kLargest = 1e60;
constexpr double kWrapOffset = 0.1;  // of alpha
// Volume by area^(3/2): a ball 0.094, a rod fifty times as long as thick 0.03, a plate of 1 % 0.0035.
constexpr double kNoVolume = 1e-3;
// Of the volume.  Of bodies with 5 % of their surface cut out, in one to four holes, nearly all whose volume was more
// than 0.5 % off when these were filled were beyond it, of those with many holes none.
constexpr double kToldBulge = 0.003;
constexpr std::uint64_t kManyFlaps = 10;
constexpr double kMostFlat = 0.2;   // of the surface: flat parts that are left out though open
constexpr double kToldWrap = 0.02;  // of the volume: walls and limbs of a few alphas differ by less

std::string short_text(double value) {
  return base::rounded(value, 4);
}

// What is rounding beside the others is 0.
std::string place_text(const Vec3& p) {
  const auto text = [least = 1e-12 * norm(p)](double c) { return short_text(std::abs(c) < least ? 0 : c); };
  return "(" + text(p.x) + ", " + text(p.y) + ", " + text(p.z) + ")";
}

class Mending {
 public:
  Mending(const Mesh& mesh, const RepairOptions& options) : options_(options) {
    longest_ = options.longest_hole > 0 ? options.longest_hole : kLongestHole * box_diagonal(mesh);
    orient(mesh);
    fill();
    drop_flaps();
    tell_holes_left();
    if (holds_nothing_ > 1) {
      result_.left = (holds_nothing_ < parts_ ? std::to_string(holds_nothing_) + " of " : "") + "its " +
                     std::to_string(parts_) +
                     " parts do not hang together by edges, and by itself each bounds next to no volume";
      result_.longest_left = 0;
    }
  }

  /// Whether all or most of its parts were open and hold nothing when filled, as flat ones do: what a wrap goes round
  /// may be no more.
  bool holds_nothing() const { return holds_nothing_ > 0; }

  /// @throws CoreError kBadInput for an open flat sheet, unless an alpha was asked for: filled to any length, it would
  ///   bound nothing, and a wrap, whose offset is taken back, is a crumpled film about it.
  RepairedMesh result(const RepairOptions& asked) {
    if (holds_nothing() && is_flat_sheet(result_.mesh) && asked.alpha == 0)
      refuse(
          "the mesh is an open sheet and flat, so that it bounds no volume, nor does what fills or wraps it; "
          "give it a thickness, by Blender's Solidify, say");
    return std::move(result_);
  }

 private:
  void tell(const char* code, std::uint64_t count, const std::string& message) {
    if (count > 0) result_.steps.push_back({code, count, message});
  }
  void tell(const char* code, std::uint64_t count, const char* noun, const std::string& what) {
    tell(code, count, base::counted(count, noun) + what);
  }

  void orient(const Mesh& mesh) {
    OrientedSoup soup = orient_soup(mesh, options_.context);
    tell("welded-points", soup.welded_points, "point", " at the place of another joined to it");
    tell("joined-points", soup.joined_points, "point",
         " within a millionth of the size of another joined to it");
    tell("unused-points", soup.unused_points, "point", " that no triangle names left out");
    tell("degenerate-triangles", soup.degenerate, "triangle", " with two corners at one place left out");
    tell("repeated-triangles", soup.repeated, "triangle", " beside another of the same corners left out");
    tell("t-junctions", soup.junctions, "point", " put into edges that they lie on (T-junctions)");
    tell("turned-triangles", soup.turned, "triangle", " turned to agree with the others");
    tell("separated-points", soup.separated_points, "point",
         " doubled, so that at every edge two triangles meet");
    tell("stitched-edges", soup.stitched_edges, "pair", " of edges between the same points joined");
    result_.mesh = std::move(soup.mesh);
  }

  void fill() {
    const double area = surface_area(result_.mesh);
    FilledHoles filled = fill_holes(result_.mesh, {longest_, options_.context});
    std::uint64_t count = 0;
    double added = 0;
    const Hole* longest = nullptr;
    for (const Hole& hole : filled.holes) {
      added += hole.area;
      result_.bulge += hole.bulge;
      if (!hole.filled) continue;
      ++count;
      if (longest == nullptr) longest = &hole;
    }
    if (count > 0) {
      result_.longest_filled = longest->length;
      tell("filled-holes", count,
           base::counted(count, "hole") + " filled, the longest " + short_text(longest->length) +
               " round near " + place_text(longest->centre) + ", together " +
               short_text(100 * added / (area + added)) + " % of the surface");
    }
    result_.filled_share = added / (area + added);
    result_.mesh = std::move(filled.mesh);
    holes_ = std::move(filled.holes);
  }

  // But those of what was left out.
  void tell_holes_left() {
    std::uint64_t left = 0;
    const Hole* longest = nullptr;
    for (const Hole& hole : holes_) {
      if (hole.filled) continue;
      ++left;
      if (longest == nullptr) longest = &hole;
    }
    if (left == 0) return;
    // What is short enough could not be filled, nor what has too many edges: no greater length helps.
    const bool too_long = longest->length > longest_ && longest->edges <= kMaxHoleEdges;
    result_.longest_left = too_long ? longest->length : 0;
    const std::string of_all = left < holes_.size() ? " of " + std::to_string(holes_.size()) : "";
    result_.left = base::counted(left, "hole") + of_all + (left == 1 ? " is" : " are") +
                   " left, the longest " + short_text(longest->length) + " round near " +
                   place_text(longest->centre);
    if (!too_long)
      result_.left += ", of " + base::counted(longest->edges, "edge") + ", more than can be filled";
  }

  // Triangles that hang together by edges.
  static DisjointSets parts_of(const Mesh& mesh) {
    DisjointSets parts(mesh.triangles.size());
    Edges(mesh.points.size(), mesh.triangles)
        .for_each([&](std::uint32_t, std::uint32_t, std::span<const EdgeSide> sides) {
          for (const EdgeSide& side : sides) parts.unite(sides[0].triangle(), side.triangle());
        });
    return parts;
  }

  // Parts that were open and enclose next to nothing now, or are open yet and flat.
  void drop_flaps() {
    Mesh& mesh = result_.mesh;
    DisjointSets parts = parts_of(mesh);
    const std::size_t count = mesh.triangles.size();
    std::vector<double> volume(count, 0), area(count, 0);
    std::vector<bool> was_open(count, false), is_open(count, false);
    std::vector<bool> rim(mesh.points.size(), false), rim_left(mesh.points.size(), false);
    for (const Hole& hole : holes_) (hole.filled ? rim : rim_left)[hole.point] = true;
    const auto on = [](const std::vector<bool>& points, const Triangle& t) {
      return points[t[0]] || points[t[1]] || points[t[2]];
    };
    double whole_area = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
      const Triangle& t = mesh.triangles[i];
      const std::uint32_t part = parts.find(i);
      const Vec3 origin = mesh.points[mesh.triangles[part][0]];
      const Vec3 a = mesh.points[t[0]] - origin, b = mesh.points[t[1]] - origin,
                 c = mesh.points[t[2]] - origin;
      volume[part] += dot(a, cross(b, c)) / 6;
      area[part] += 0.5 * norm(cross(b - a, c - a));
      whole_area += 0.5 * norm(cross(b - a, c - a));
      if (on(rim, t)) was_open[part] = true;
      if (on(rim_left, t)) is_open[part] = true;
    }
    std::vector<std::vector<std::uint32_t>> corners(count);  // of parts that are open yet
    for (std::uint32_t i = 0; i < count; ++i) {
      const std::uint32_t part = parts.find(i);
      if (is_open[part])
        corners[part].insert(corners[part].end(), mesh.triangles[i].begin(), mesh.triangles[i].end());
    }
    std::vector<bool> is_flap(count, false);
    std::uint64_t flaps = 0, sound = 0;
    double flat_area = 0, flap_area = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
      if (parts.find(i) != i || area[i] == 0) continue;
      is_flap[i] = is_open[i] ? lie_in_a_plane(mesh, corners[i])
                              : was_open[i] && std::fabs(volume[i]) < kNoVolume * std::pow(area[i], 1.5);
      (is_flap[i] ? flaps : sound) += 1;
      if (is_flap[i]) (is_open[i] ? flat_area : flap_area) += area[i];
    }
    parts_ = flaps + sound;
    const double share = (flat_area + flap_area) / whole_area;
    if (sound == 0 || (flaps >= kManyFlaps && share > 0.5)) holds_nothing_ = flaps;
    // Sides of a solid, rather, which a wrap may join.
    if (flaps == 0 || holds_nothing_ > 0 || (options_.kind == RepairKind::kWrap && share > kMostFlat)) return;
    if (flat_area > kMostFlat * whole_area) {
      for (std::uint32_t i = 0; i < count; ++i) {
        if (!is_flap[i] || !is_open[i]) continue;
        is_flap[i] = false;
        --flaps;
      }
    }
    std::vector<Triangle> kept;
    std::vector<bool> on_flap(mesh.points.size(), false);
    for (std::uint32_t i = 0; i < count; ++i) {
      const Triangle& t = mesh.triangles[i];
      if (!is_flap[parts.find(i)]) {
        kept.push_back(t);
      } else {
        on_flap[t[0]] = on_flap[t[1]] = on_flap[t[2]] = true;
      }
    }
    std::erase_if(holes_, [&](const Hole& hole) { return !hole.filled && on_flap[hole.point]; });
    mesh.triangles = std::move(kept);
    drop_unused_points(mesh);
    tell("flaps", flaps, "part", " without volume left out");
  }

  const RepairOptions& options_;
  double longest_ = 0;
  std::uint64_t parts_ = 0;
  std::uint64_t holds_nothing_ = 0;  // how many parts, where all or most were open, and enclose nothing
  RepairedMesh result_;
  std::vector<Hole> holes_;  // longest first, but those of flaps
};

void tell_wrap(const AlphaWrapOptions& wrap, SolidWrap wrapped, RepairedMesh& result) {
  const Mesh& mesh = result.mesh = std::move(wrapped.mesh);
  DisjointSets pieces(mesh.points.size());
  auto count = static_cast<std::int64_t>(mesh.points.size());
  for (const Triangle& t : mesh.triangles)
    for (const std::uint32_t v : {t[1], t[2]}) count -= pieces.unite(t[0], v) ? 1 : 0;
  // Euler and Poincare: a closed surface has half as many edges again as triangles.
  const auto characteristic =
      static_cast<std::int64_t>(mesh.points.size()) - static_cast<std::int64_t>(mesh.triangles.size() / 2);
  const auto handles = static_cast<std::uint64_t>(count - characteristic / 2);
  std::string made = base::counted(static_cast<std::uint64_t>(count) - wrapped.kept, "piece");
  if (handles > 0) made += " with " + base::counted(handles, "handle");
  if (wrapped.kept > 0)
    made += (handles > 0 ? " and " : " with ") + base::counted(wrapped.kept, "cavity", "cavities");
  result.steps.push_back({"wrapped", mesh.triangles.size(),
                          "wrapped by " + base::counted(mesh.triangles.size(), "triangle") + " in " + made +
                              ", hollows narrower than " + short_text(wrap.alpha) + " are closed"});
  if (wrapped.closed > 0) {
    result.steps.push_back({"closed-cavities", wrapped.closed,
                            base::counted(wrapped.closed, "cavity", "cavities") +
                                " closed, and what lies in them swallowed: too narrow for a ball of radius " +
                                short_text(wrap.alpha) + ", or with walls that cross another surface",
                            MeshNote::Severity::kWarning});
  }
  result.wrapped_volume = wrapped.volume;
  result.wrapped_overlaps = wrapped.overlaps;
}

// The surface through a cloud, with what was done for it. @return spacing of its points.
double surface_cloud(const std::vector<Vec3>& points, ExecutionContext* context, RepairedMesh& result) {
  CloudSurface cloud = cloud_surface(points, context);
  if (cloud.lone > 0)
    result.steps.push_back(
        {"lone-points", cloud.lone, base::counted(cloud.lone, "point") + " far from all others left out"});
  result.steps.push_back(
      {"surfaced", cloud.used,
       "a surface laid through " + base::counted(cloud.used, "point") + ", " + short_text(cloud.spacing) +
           " apart; it lies " + short_text(cloud.mean_distance) + " from them in the mean" +
           (cloud.unseen > 0 ? ", and no point is near " + short_text(100 * cloud.unseen) + " % of it"
                             : "")});
  result.mesh = std::move(cloud.mesh);
  return cloud.spacing;
}

RepairedMesh wrapped(const Mesh& mesh, const RepairOptions& options) {
  const double finest = kFinestWrap * box_diagonal(mesh);
  if (options.alpha > 0 && options.alpha < finest) {
    refuse("a wrap by alpha " + short_text(options.alpha) + " would be too fine; take " +
           short_text(1.01 * finest) + " or more");
  }
  if (options.alpha > box_diagonal(mesh)) {
    refuse("a wrap by alpha " + short_text(options.alpha) + " would be a box round all of it; take " +
           short_text(0.1 * box_diagonal(mesh)) + " or less");
  }
  AlphaWrapOptions wrap;
  wrap.context = options.context;
  wrap.alpha = kWrapDetail * box_diagonal(mesh);
  RepairedMesh result;
  bool is_film = false;  // what is wrapped, unless its parts have others behind them
  if (mesh.triangles.empty()) {
    wrap.alpha = std::max(wrap.alpha, surface_cloud(mesh.points, options.context, result));
  } else {
    // Through a hole that is wider than alpha the wrap would enter.
    RepairOptions all = options;
    all.longest_hole = HUGE_VAL;
    Mending mending(mesh, all);
    is_film = mending.holds_nothing();
    result = mending.result(options);
    result.left.clear();
  }
  if (options.alpha > 0) wrap.alpha = options.alpha;
  wrap.offset = options.offset > 0 ? options.offset : kWrapOffset * wrap.alpha;
  tell_wrap(wrap, wrap_solid(result.mesh, wrap), result);
  // A film's walls may have stayed an offset off each.
  const double surface = surface_area(result.mesh);
  const double film = std::max(kNoVolume * std::pow(surface, 1.5), wrap.offset * surface);
  if (is_film && options.alpha == 0 && std::fabs(enclosed_volume(result.mesh)) < film) {
    refuse(
        "the mesh consists of open sheets that bound no volume, and a wrap would be a film about them; give them a "
        "thickness, by Blender's Solidify, say, or wrap them by an alpha of your own");
  }
  return result;
}

// Turns its surfaces as those of a solid.  What is whole may still be none: two triangles on each other, say.
void face_outward(RepairedMesh& result, const RepairOptions& options) {
  try {
    const Solid solid =
        make_solid(result.mesh, {.check_self_intersections = false, .context = options.context});
    result.volume = solid.volume;
    if (turn_as_in(solid, result.mesh))
      for (const MeshNote& note : solid.notes)
        if (note.code.starts_with("turned-")) result.steps.push_back({note.code, 1, note.message});
  } catch (const CoreError& error) {
    if (error.code() != CoreError::Code::kBadInput) throw;
    result.left = error.what();
  }
  if (result.bulge > kToldBulge * result.volume && result.left.empty()) {
    result.steps.push_back(
        {"bent-fillings", 1,
         "what fills holes bends as their rims do, and holds " +
             base::rounded(100 * result.bulge / result.volume, 2) +
             " % of the volume that soap films would leave out; what was there may have differed as much"});
  }
}

void tell_wrapped_volume(RepairedMesh& result) {
  const double before = result.wrapped_volume, more = result.volume / before - 1;
  if (!(before > 0) || std::fabs(more) < kToldWrap || (more < 0 && result.wrapped_overlaps)) return;
  result.steps.push_back({"wrap-volume", 1,
                          "the wrap holds " + short_text(result.volume) + ", what it wraps " +
                              short_text(before) + (result.wrapped_overlaps ? ", overlaps twice: " : ": ") +
                              base::rounded(100 * std::fabs(more), 3) + " % " + (more > 0 ? "more" : "less"),
                          MeshNote::Severity::kWarning});
}

// Powers of lengths must not overflow, nor vanish.
void check_size(const Mesh& mesh) {
  if (mesh.points.empty()) refuse("the mesh has no points");
  const double size = box_diagonal(mesh);
  if (size == 0) refuse("all points lie at one place");
  if (!(size > kSmallest && size < kLargest)) {
    refuse("the mesh is " + short_text(size) +
           " long, from corner to corner of its box; change the unit of length");
  }
}

}  // namespace

RepairedMesh repair_mesh(const Mesh& mesh, const RepairOptions& options) {
  check_size(mesh);
  RepairedMesh result;
  if (options.kind == RepairKind::kWrap) {
    result = wrapped(mesh, options);
  } else if (mesh.triangles.empty()) {
    result.left = "there are points and no triangles";
  } else {
    result = Mending(mesh, options).result(options);
  }
  if (result.left.empty()) face_outward(result, options);
  if (result.left.empty()) tell_wrapped_volume(result);
  return result;
}

}  // namespace affskel::core
