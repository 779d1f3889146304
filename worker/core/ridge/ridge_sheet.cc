#include "core/ridge/ridge_sheet.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <span>
#include <utility>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/collapse/collapse.h"
#include "core/collapse/shortest_loops.h"
#include "core/collapse/thinned_solid.h"
#include "core/contour/dual_contour.h"
#include "core/contour/edge_cells.h"
#include "core/lattice/lattice_coordinates.h"
#include "core/lattice/solid_parts.h"
#include "core/mesh/box.h"
#include "core/mesh/laplacian.h"
#include "core/ridge/bored_cells.h"
#include "core/ridge/local_depth.h"
#include "core/ridge/ridge_anchors.h"
#include "core/ridge/ridge_crossings.h"
#include "core/ridge/ridge_curves.h"
#include "core/ridge/ridge_values.h"
#include "core/ridge/skeleton_mesh.h"
#include "core/ridge/spikes.h"
#include "core/spatial/distance_to_mesh.h"

namespace affskel::core {
namespace {

// With fewer points those near the surface are so many that the limbs and the derivatives, found at the same time, take
// more memory than all that comes after them.
constexpr std::uint32_t kBesideEachOther = 500'000;

constexpr int kSmoothings = 2;  // enough to hide noise as large as triangles

Mesh smoothed(Mesh surface) {
  smooth(surface, kSmoothings);
  return surface;
}

// The root of the mean squared distance of vertices.
double distance_between(const Mesh& a, const Mesh& b) {
  double sum = 0;
  for (std::size_t v = 0; v < a.points.size(); ++v)
    sum += dot(a.points[v] - b.points[v], a.points[v] - b.points[v]);
  return std::sqrt(sum / static_cast<double>(a.points.size()));
}

// A surface that noise makes cross itself, without the noise.
struct WithoutNoise {
  explicit WithoutNoise(const Mesh& walls)
      : surface(smoothed(walls)), distance(surface), noise(distance_between(walls, surface)) {}

  const Mesh surface;
  const DistanceToMesh distance;
  const double noise;
};

// The surface of a solid, lattice coordinates.
struct Walls {
  Walls(const Solid& solid, const Lattice& lattice, unsigned threads)
      : mesh(surface_in_lattice(solid, lattice)), distance(mesh, threads) {
    if (solid.is_folded()) clean.emplace(mesh);
  }

  const Mesh mesh;
  const DistanceToMesh distance;
  std::optional<WithoutNoise> clean;  // of one that is folded
};

// A vertex has the mean of its cell's crossings, normals turned to agree with the first.
SheetMesh contour(const Lattice& lattice, const SolidParts& parts, const EdgeCells& cells,
                  const std::deque<RidgeCrossing>& crossings, ExecutionContext* context) {
  std::vector<SheetCrossing> places;
  places.reserve(crossings.size());
  for (const RidgeCrossing& crossing : crossings) places.push_back({crossing.at.position, crossing.normal});
  const auto mean = [&](const Vec3&, std::span<const std::uint32_t> members) {
    SheetVertex vertex = crossings[members[0]].at;
    for (std::size_t n = 1; n < members.size(); ++n)
      vertex = between(vertex, crossings[members[n]].at, 1 / static_cast<double>(n + 1));
    return vertex;
  };
  return dual_contour(lattice, parts, cells, places, mean, context);
}

// A way costs a thousand times as much as in the middle at most, so that the queue of ways stays short.  At a hundred
// times hands cost alike all through, and the lattice's order led the line.
constexpr double kLeastEase = 0.001;

// What a way costs for each spacing of its length: little in the middle of the solid, where E and the distance
// to the surface are large.
std::vector<float> costs_of_ways(const FrameField& field, std::span<const float> radius) {
  const double deepest = *std::max_element(field.erosion.begin(), field.erosion.end());
  const double widest = static_cast<double>(*std::max_element(radius.begin(), radius.end()));
  std::vector<float> cost(radius.size());
  for (std::size_t p = 0; p < cost.size(); ++p) {
    const double ease =
        std::sqrt(std::sqrt(field.erosion[p] / deepest)) * static_cast<double>(radius[p]) / widest;
    cost[p] = static_cast<float>(1 / std::max(kLeastEase, ease));
  }
  return cost;
}

// The components of the complex that are left out go, to the last cell.
void drop(const DualComplex& complex, const std::vector<char>& left_out, CellSet& cells) {
  for (std::uint32_t cube = 0; cube < complex.cubes(); ++cube)
    if (left_out[cube]) cells.clear(cube);
}

std::vector<LatticeLoop> loops_of(const Lattice& lattice, const DualComplex& complex, const CellSet& thinned,
                                  ExecutionContext* context) {
  std::vector<LatticeLoop> result;
  for (const CellLoop& loop : shortest_loops(complex, thinned, kMaxLoops, context)) {
    Box box;
    for (const Vec3& place : places_of_vertices(lattice, loop.vertices)) box.include(place);
    result.push_back({lattice.spacing * box.middle(), box.diagonal()});
  }
  return result;
}

// Of what is left of a complex the cells that bound no other.
std::vector<DualComplex::Cell> core_of(const DualComplex& complex, const CellSet& left) {
  std::vector<DualComplex::Cell> core;
  left.for_each([&](DualComplex::Cell cell) {
    if (DualComplex::dimension(cell) > 0 && is_bare(complex, cell, left)) core.push_back(cell);
  });
  return core;
}

std::vector<Vec3> mesh_places(const Solid& solid, const Lattice& lattice, const SheetMesh& sheet) {
  const Vec3 origin = SamplePlaces(solid, lattice).origin();
  const Matrix3 frame = frame_matrix(lattice);
  std::vector<Vec3> places;
  places.reserve(sheet.vertices.size());
  for (const SheetVertex& vertex : sheet.vertices) places.push_back(origin + frame * vertex.position);
  return places;
}

// Of one surface that crosses itself: where several do, what they bound together may have tunnels that none has.
std::optional<NoisySolid> noisy_solid(const Solid& solid, const Lattice& lattice, const RidgeBasis& basis) {
  if (!solid.self_intersecting || solid.shells.size() > 1) return std::nullopt;
  return NoisySolid{lattice, basis.complex, basis.radius, basis.thickness, betti_numbers(solid).holes};
}

// Whether there are any.
bool take_limbs(const std::vector<LimbTip>& limbs, RidgeAnchors& chosen) {
  for (const LimbTip& tip : limbs) chosen.anchors.push_back(anchor_of(tip));
  chosen.limbs += static_cast<std::uint32_t>(limbs.size());
  return !limbs.empty();
}

// What is left of the complex has tunnels and voids that the solid lacks: too coarse a lattice, or noise.
void fill(const Solid& solid, const Lattice& lattice, const RidgeBasis& basis,
          std::span<const Anchor> anchors, ExecutionContext* context, CellSet& left, RidgeSheet& sheet) {
  if (basis.topology.holes + basis.topology.cavities == 0) return;
  if (const auto bored = noisy_solid(solid, lattice, basis)) {
    sheet.lattice = fill_bored(*bored, basis.topology, anchors, left, context);
  } else {
    sheet.filled = fill_tunnels(solid, lattice, basis.complex, anchors, basis.radius, left, context);
    sheet.lattice.holes -= static_cast<std::uint64_t>(sheet.filled.edges.size());
  }
}

class SheetMaker {
 public:
  SheetMaker(const Solid& solid, const Lattice& lattice, const FrameField& field, const RidgeBasis& basis,
             const RidgeSheetOptions& options)
      : solid_(solid),
        lattice_(lattice),
        field_(field),
        basis_(basis),
        options_(options),
        parts_(solid, lattice),
        walls_(solid, lattice, options.threads) {}

  RidgeSheet run() {
    find_ridges();
    Collapsed left = collapsed_onto_ridges();
    RidgeSheet sheet;
    sheet.lattice = basis_.topology;
    fill(solid_, lattice_, basis_, chosen_.anchors, options_.context, left.cells, sheet);
    sheet.fragments = chosen_.fragments;
    sheet.limbs = chosen_.limbs + static_cast<std::uint32_t>(sheet.filled.limbs.size());
    sheet.opened = left.opened;
    sheet.strongest = strongest_;
    static_cast<SkeletonMesh&>(sheet) = placed(left.cells);
    sheet.unreached = unreached_ends(solid_, lattice_, chosen_.left_out, mesh_places(solid_, lattice_, sheet),
                                     options_.context);
    return sheet;
  }

 private:
  // From a weak strength on.
  void find_ridges() {
    std::deque<RidgeCrossing> crossings;
    {
      const RidgeValues values(lattice_, field_, basis_.derivatives, basis_.radius, walls_.distance,
                               walls_.clean ? &walls_.clean->distance : nullptr,
                               RidgeConstants::weak_share * options_.bounds.low, options_.threads);
      throw_if_stopped(options_.context);
      crossings = ridge_crossings(lattice_, values, options_.threads);
      throw_if_stopped(options_.context);
      curves_ = ridge_curves(lattice_, values, options_.context);
    }
    throw_if_stopped(options_.context);
    for (const RidgeCrossing& crossing : crossings) {
      edges_.push_back(crossing.edge);
      strengths_.push_back(crossing.at.strength);
      look_at(crossing.at);
    }
    for (const RidgeCurve& curve : curves_)
      std::ranges::for_each(curve.vertices, [&](const auto& vertex) { look_at(vertex); });
    cells_ = edge_cells(lattice_, basis_.complex, parts_, edges_);
    surface_ = contour(lattice_, parts_, cells_, crossings, options_.context).vertices;
  }

  // Round places found none, however strong.
  void look_at(const SheetVertex& vertex) {
    if (vertex.roundness <= RidgeConstants::max_roundness) strongest_ = std::max(strongest_, vertex.strength);
  }

  // What is left of the solid, but for fragments.
  Collapsed collapsed_onto_ridges() {
    SpikyLimbs limbs{basis_.complex, basis_.radius, basis_.thickness, basis_.limbs,
                     walls_.clean ? walls_.clean->noise : 0};
    const std::vector<char> doubtful = possible_spikes(solid_, walls_.mesh, lattice_, limbs);
    const RidgeEvidence evidence{.complex = basis_.complex,
                                 .parts = parts_,
                                 .field = field_,
                                 .edges = edges_,
                                 .strength = strengths_,
                                 .cells = cells_,
                                 .vertices = surface_,
                                 .curves = curves_,
                                 .limbs = basis_.limbs,
                                 .radius = basis_.radius,
                                 .doubtful = doubtful,
                                 .core = basis_.core};
    chosen_ = ridge_anchors(evidence, options_.bounds, options_.context);
    const auto collapsed = [&] {
      std::vector<Anchor> anchors = chosen_.anchors;
      anchors.insert(anchors.end(), chosen_.core.begin(), chosen_.core.end());
      return collapse(basis_.complex, anchors,
                      {.cost = costs_of_ways(field_, basis_.radius), .context = options_.context});
    };
    Collapsed left = collapsed();
    limbs.tips = chosen_.doubtful;
    if (take_limbs(limbs_without_spikes(limbs, left.cells), chosen_)) left = collapsed();
    if (count_components(basis_.complex, left.cells) != basis_.topology.components)
      throw CoreError(CoreError::Code::kInternal, "the collapse has parted what hangs together");
    drop(basis_.complex, chosen_.left_out, left.cells);
    return left;
  }

  SkeletonMesh placed(const CellSet& left) const {
    const SkeletonParts from{.lattice = lattice_,
                             .parts = parts_,
                             .field = field_,
                             .cells = cells_,
                             .surface = surface_,
                             .anchors = chosen_,
                             .derivatives = basis_.derivatives,
                             .radius = basis_.radius,
                             .nearest = walls_.distance,
                             .low = options_.bounds.low};
    return skeleton_mesh(solid_, basis_.complex, left, from, options_.context);
  }

  const Solid& solid_;
  const Lattice& lattice_;
  const FrameField& field_;
  const RidgeBasis& basis_;
  const RidgeSheetOptions& options_;
  const SolidParts parts_;
  const Walls walls_;
  std::vector<LatticeEdge> edges_;    // that the surface crosses
  std::vector<double> strengths_;     // there
  double strongest_ = 0;              // that may found a ridge
  EdgeCells cells_;                   // about them
  std::vector<SheetVertex> surface_;  // per cell
  std::vector<RidgeCurve> curves_;
  RidgeAnchors chosen_;
};

// What thinning the whole complex tells.
void find_limbs(const Solid& solid, const Lattice& lattice, const FrameField& field,
                ExecutionContext* context, RidgeBasis& basis) {
  const DualComplex& complex = basis.complex;
  ThinnedSolid thinned = thinned_solid(complex, basis.radius, field.erosion, context);
  const std::optional<NoisySolid> noisy = noisy_solid(solid, lattice, basis);
  const bool has_cuts = noisy || basis.topology.holes > 0;
  CellSet left;  // lines without ends: what limbs leave, where nothing is cut
  if (has_cuts) left = collapsed(complex, thinned.cells, {}, context);
  std::vector<DualComplex::Cell> cuts;
  if (noisy) {
    cuts = bored_cells(*noisy, left, {}, context).cells;
  } else if (has_cuts) {
    CellSet filled = left;
    cuts = fill_tunnels(solid, lattice, complex, {}, basis.radius, filled, context).edges;
  }
  LimbTips found = limb_tips(std::move(thinned), RidgeConstants::limb_reach, cuts, context);
  basis.limbs = std::move(found.tips);
  if (noisy || !has_cuts) left = std::move(found.left);
  if (!noisy) {  // the skeleton has the loops
    const auto cut = std::ranges::stable_partition(basis.limbs, std::logical_not(), &LimbTip::is_cut);
    basis.cut_limbs.assign(cut.begin(), cut.end());
    basis.limbs.erase(cut.begin(), cut.end());
  }
  basis.core = core_of(complex, left);
  basis.loops = loops_of(lattice, complex, left, context);
}

}  // namespace

RidgeBasis ridge_basis(const Solid& solid, const Lattice& lattice, const FrameField& field, unsigned threads,
                       ExecutionContext* context) {
  RidgeBasis basis{DualComplex(lattice)};
  parallel_for(threads, 2, [&](std::size_t n) {
    if (n == 0)
      basis.topology = betti_numbers(basis.complex, context);
    else
      basis.radius = surface_distance(lattice, context);
  });
  if (solid.self_intersecting) basis.thickness = section_radii(field);
  const bool at_once = threads > 1 && lattice.points >= kBesideEachOther;
  parallel_for(at_once ? 2 : 1, 2, [&](std::size_t n) {
    if (n == 0)
      find_limbs(solid, lattice, field, context, basis);
    else
      basis.derivatives = smoothed_derivatives(lattice, field, at_once ? threads - 1 : threads, context);
  });
  return basis;
}

RidgeSheet ridge_sheet(const Solid& solid, const Lattice& lattice, const FrameField& field,
                       const RidgeBasis& basis, const RidgeSheetOptions& options) {
  if (basis.derivatives.size() != lattice.points) refuse("the basis is not that of this lattice");
  return SheetMaker(solid, lattice, field, basis, options).run();
}

}  // namespace affskel::core
