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
#include "core/repair/orient_soup.h"
#include "core/repair/wrap_solid.h"
#include "core/solid/solid.h"
#include "core/solid/surface_samples.h"

namespace affskel::core {
namespace {

constexpr double kLongestHole = 0.6;        // of the box's diagonal: half of a body's back, a sleeve, a neck
constexpr double kWrapDetail = 1.0 / 220;   // of the box's diagonal
constexpr double kFinestWrap = 1.0 / 2000;  // of the box's diagonal: some five million triangles, and minutes
constexpr double kSmallest = 1e-60, kLargest = 1e60;
constexpr double kWrapOffset = 0.1;  // of alpha
// Volume by area^(3/2): a ball 0.094, a rod fifty times as long as thick 0.03, a plate of 1 % 0.0035.
constexpr double kNoVolume = 1e-3;
// Of the volume.  Of bodies with 5 % of their surface cut out, in one to four holes, nearly all whose volume was more than
// 0.5 % off when these were filled were beyond it, of those with many holes none.
constexpr double kToldBulge = 0.003;
constexpr double kToldWrap = 0.02;  // of the volume: walls and limbs of a few alphas differ by less

std::string short_text(double value) {
  return base::rounded(value, 4);
}

std::string place_text(const Vec3& p) {
  return "(" + short_text(p.x) + ", " + short_text(p.y) + ", " + short_text(p.z) + ")";
}

double diagonal(const Mesh& mesh) {
  return box_of(mesh.points).diagonal();
}

class Mending {
 public:
  Mending(const Mesh& mesh, const RepairOptions& options) : options_(options) {
    longest_ = options.longest_hole > 0 ? options.longest_hole : kLongestHole * diagonal(mesh);
    orient(mesh);
    fill();
    drop_flaps();
  }

  /// @throws CoreError kBadInput for an open sheet, but with lengths of one's own: filled, it would bound nothing, and
  ///   wrapped by an alpha that suits its length, a film.
  RepairedMesh result(const RepairOptions& asked) {
    if (is_sheet_ && asked.alpha == 0 && asked.longest_hole == 0)
      refuse(
          "the mesh is an open sheet and flat, so that it bounds no volume; give it a thickness, by "
          "Blender's Solidify, say, or wrap it by an alpha of your own");
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
    std::uint64_t count = 0, left = 0;
    double added = 0;
    const Hole *longest = nullptr, *longest_left = nullptr;
    for (const Hole& hole : filled.holes) {
      (hole.filled ? count : left) += 1;
      added += hole.area;
      result_.bulge += hole.bulge;
      const Hole*& seen = hole.filled ? longest : longest_left;
      if (seen == nullptr) seen = &hole;
      rims_.push_back(hole.point);
    }
    if (count > 0) {
      result_.longest_filled = longest->length;
      tell("filled-holes", count,
           base::counted(count, "hole") + " filled, the longest " + short_text(longest->length) +
               " round near " + place_text(longest->centre) + ", together " +
               short_text(100 * added / (area + added)) + " % of the surface");
    }
    if (left > 0) {
      // What is short enough could not be filled, nor what has too many edges: no greater length helps.
      const bool too_long = longest_left->length > longest_ && longest_left->edges <= kMaxHoleEdges;
      result_.longest_left = too_long ? longest_left->length : 0;
      const std::string of_all = count > 0 ? " of " + std::to_string(count + left) : "";
      result_.left = base::counted(left, "hole") + of_all + (left == 1 ? " is" : " are") +
                     " left, the longest " + short_text(longest_left->length) + " round near " +
                     place_text(longest_left->centre);
      if (!too_long)
        result_.left += ", of " + base::counted(longest_left->edges, "edge") + ", more than can be filled";
    }
    result_.filled_share = added / (area + added);
    result_.mesh = std::move(filled.mesh);
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

  // Parts that were open and enclose next to nothing now.
  void drop_flaps() {
    Mesh& mesh = result_.mesh;
    DisjointSets parts = parts_of(mesh);
    const std::size_t count = mesh.triangles.size();
    std::vector<double> volume(count, 0), area(count, 0);
    std::vector<bool> was_open(count, false), rim(mesh.points.size(), false);
    for (const std::uint32_t v : rims_) rim[v] = true;
    for (std::uint32_t i = 0; i < count; ++i) {
      const Triangle& t = mesh.triangles[i];
      const std::uint32_t part = parts.find(i);
      const Vec3 origin = mesh.points[mesh.triangles[part][0]];
      const Vec3 a = mesh.points[t[0]] - origin, b = mesh.points[t[1]] - origin,
                 c = mesh.points[t[2]] - origin;
      volume[part] += dot(a, cross(b, c)) / 6;
      area[part] += 0.5 * norm(cross(b - a, c - a));
      if (rim[t[0]] || rim[t[1]] || rim[t[2]]) was_open[part] = true;
    }
    const auto is_flap = [&](std::uint32_t part) {
      return was_open[part] && std::fabs(volume[part]) < kNoVolume * std::pow(area[part], 1.5);
    };
    std::uint64_t flaps = 0, sound = 0;
    for (std::uint32_t i = 0; i < count; ++i)
      if (parts.find(i) == i && area[i] > 0) (is_flap(i) ? flaps : sound) += 1;
    is_sheet_ = sound == 0 && is_flat_sheet(mesh);
    if (flaps == 0 || sound == 0) return;
    std::vector<Triangle> kept;
    for (std::uint32_t i = 0; i < count; ++i)
      if (!is_flap(parts.find(i))) kept.push_back(mesh.triangles[i]);
    mesh.triangles = std::move(kept);
    drop_unused_points(mesh);
    tell("flaps", flaps, "part", " without volume left out");
  }

  const RepairOptions& options_;
  double longest_ = 0;
  bool is_sheet_ = false;  // all parts were open, and together they enclose nothing
  RepairedMesh result_;
  std::vector<std::uint32_t> rims_;  // of each hole a point
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
                                short_text(wrap.alpha) + ", or with walls that cross another surface"});
  }
  result.wrapped_volume = wrapped.volume;
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
  const double finest = kFinestWrap * diagonal(mesh);
  if (options.alpha > 0 && options.alpha < finest) {
    refuse("a wrap by alpha " + short_text(options.alpha) + " would be too fine; take " +
           short_text(1.01 * finest) + " or more");
  }
  if (options.alpha > diagonal(mesh)) {
    refuse("a wrap by alpha " + short_text(options.alpha) + " would be a box round all of it; take " +
           short_text(0.1 * diagonal(mesh)) + " or less");
  }
  AlphaWrapOptions wrap;
  wrap.context = options.context;
  wrap.alpha = kWrapDetail * diagonal(mesh);
  RepairedMesh result;
  if (mesh.triangles.empty()) {
    wrap.alpha = std::max(wrap.alpha, surface_cloud(mesh.points, options.context, result));
  } else {
    // Through a hole that is wider than alpha the wrap would enter.
    RepairOptions all = options;
    all.longest_hole = HUGE_VAL;
    result = Mending(mesh, all).result(options);
    result.left.clear();
  }
  if (options.alpha > 0) wrap.alpha = options.alpha;
  wrap.offset = options.offset > 0 ? options.offset : kWrapOffset * wrap.alpha;
  tell_wrap(wrap, wrap_solid(result.mesh, wrap), result);
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
  if (!(before > 0) || std::fabs(more) < kToldWrap) return;
  result.steps.push_back({"wrap-volume", 1,
                          "the wrap holds " + short_text(result.volume) + ", what it wraps " +
                              short_text(before) + ": " + base::rounded(100 * std::fabs(more), 3) + " % " +
                              (more > 0 ? "more" : "less")});
}

// Powers of lengths must not overflow, nor vanish.
void check_size(const Mesh& mesh) {
  if (mesh.points.empty()) refuse("the mesh has no points");
  const double size = diagonal(mesh);
  if (size == 0) refuse("all points lie at one place");
  if (!(size > kSmallest && size < kLargest)) {
    refuse("the mesh is " + short_text(size) +
           " long, from corner to corner of its box; change the unit of length");
  }
}

}  // namespace

bool is_flat_sheet(const Mesh& mesh) {
  constexpr double kNothing =
      1e-6;  // volume by area^(3/2), as kNoVolume: single precision gives a flat sheet 1e-7
  return std::fabs(enclosed_volume(mesh)) < kNothing * std::pow(surface_area(mesh), 1.5);
}

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
