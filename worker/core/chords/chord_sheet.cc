// Placing a vertex: least squares on the tangent planes of its cell's shocks, drawn towards their mean.  On
// the rim the mean alone would lie on the outermost shocks, and a strip one shock wide would have no area:
// there a vertex goes half way to the middle of its cell, in the sheet's plane.  What comes to lie outside
// the solid goes back to the shocks' mean or the nearest shock.
#include "core/chords/chord_sheet.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/matrix3.h"
#include "core/base/require.h"
#include "core/base/scaled_to_unit.h"
#include "core/chords/chord_cells.h"
#include "core/chords/chord_edge.h"
#include "core/chords/chord_pinholes.h"
#include "core/lattice/lattice_coordinates.h"
#include "core/lattice/layer_index.h"
#include "core/lattice/solid_parts.h"
#include "core/solid/solid_membership.h"

namespace affskel::core {
namespace {

// Rows of a symmetric positive definite matrix.
using Matrix = std::array<Vec3, 3>;

Vec3 solve(const Matrix& m, const Vec3& b) {
  const Vec3 c0 = cross(m[1], m[2]), c1 = cross(m[2], m[0]), c2 = cross(m[0], m[1]);
  return (1 / dot(m[0], c0)) * (b.x * c0 + (b.y * c1 + b.z * c2));
}

Vec3 unit(const Vec3& v) {
  const Vec3 near = scaled_to_unit(v);
  const double length = norm(near);
  return length > 0 ? (1 / length) * near : Vec3{};
}

// Which places of the frame lie inside the parts of a solid.
class PartInterior {
 public:
  PartInterior(const SolidParts& parts, const Lattice& lattice) : lattice_(lattice), meshes_(parts.meshes()) {
    membership_.reserve(meshes_.size());
    for (const Mesh& mesh : meshes_) membership_.emplace_back(mesh);
  }

  bool contains(std::uint32_t part, const Vec3& u) const {
    return membership_[part].contains(scaled_place(lattice_, (1 / lattice_.spacing) * u));
  }

 private:
  const Lattice& lattice_;
  std::vector<Mesh> meshes_;
  std::vector<SolidMembership> membership_;
};

class Contouring {
 public:
  Contouring(const Lattice& lattice, const SolidParts& parts, const std::vector<ChordShock>& shocks,
             double regularisation)
      : spacing_(lattice.spacing),
        parts_(parts),
        shocks_(shocks),
        regularisation_(regularisation),
        to_mesh_(inverse_transposed(frame_matrix(lattice))),
        cells_(chord_cells(lattice, parts, shocks)),
        ranks_(lattice),
        interior_(parts, lattice) {}

  void run(ChordSheet& sheet, ExecutionContext* context) {
    sheet.vertices.reserve(cells_.size());
    std::int64_t reached = -1;
    for (std::uint32_t cell = 0; cell < cells_.size(); ++cell) {
      for (; reached < cells_.place[cell][0]; ranks_.move_to(static_cast<std::uint32_t>(++reached)))
        throw_if_stopped(context);
      sheet.vertices.push_back(vertex(cell));
    }
    for (const auto& ring : cells_.ring) add_quad(ring, sheet);
  }

 private:
  // A shock of a cell, its normal and its two sides turned to agree with the first shock's.
  struct Side {
    Vec3 normal, gradient_a, gradient_b;
  };

  // |grad_x E| = |F^-T g| for a gradient g in the frame: the area of the section.
  double area(const Vec3& g) const {
    return std::ldexp(norm(to_mesh_ * scaled_to_unit(g)), largest_exponent(g));
  }

  Side side(const ChordShock& shock, const Vec3& reference) const {
    const Vec3 normal = unit(shock.gradient_low - shock.gradient_high);
    if (dot(normal, reference) < 0) return {-normal, shock.gradient_high, shock.gradient_low};
    return {normal, shock.gradient_low, shock.gradient_high};
  }

  ChordSheetVertex vertex(std::uint32_t cell) const {
    const std::span<const std::uint32_t> members = cells_.shocks_of(cell);
    const ChordShock& first = shocks_[members[0]];
    const Vec3 reference = first.gradient_low - first.gradient_high;
    const double share = 1 / static_cast<double>(members.size());
    ChordSheetVertex v;
    v.position = kept_inside(cell, place(cell, reference));
    for (std::uint32_t s : members) {
      const ChordShock& shock = shocks_[s];
      const Side seen = side(shock, reference);
      // Along the sheet both branches change equally, so their mean gradient leads from the shock to the
      // vertex.
      const Vec3 slope = 0.5 * (shock.gradient_low + shock.gradient_high);
      v.erosion += share * (shock.erosion + dot(slope, v.position - shock.position));
      v.strength += share * shock.strength;
      v.area += share * 0.5 * (area(shock.gradient_low) + area(shock.gradient_high));
      v.normal_a = v.normal_a + unit(seen.gradient_a);
      v.normal_b = v.normal_b + unit(seen.gradient_b);
    }
    v.erosion = std::max(v.erosion, 0.0);
    v.strength = std::min(v.strength, 1.0);  // a mean may round up
    v.normal_a = unit(v.normal_a);
    v.normal_b = unit(v.normal_b);
    return v;
  }

  Vec3 place(std::uint32_t cell, const Vec3& reference) const {
    const std::span<const std::uint32_t> members = cells_.shocks_of(cell);
    const double share = 1 / static_cast<double>(members.size());
    Vec3 mean, normal;
    Matrix m{Vec3{regularisation_, 0, 0}, Vec3{0, regularisation_, 0}, Vec3{0, 0, regularisation_}};
    for (std::uint32_t s : members) {
      mean = mean + share * shocks_[s].position;
      const Vec3 n = side(shocks_[s], reference).normal;
      normal = normal + n;
      m[0] = m[0] + share * n.x * n;
      m[1] = m[1] + share * n.y * n;
      m[2] = m[2] + share * n.z * n;
    }
    const CellPlace& at = cells_.place[cell];
    const Vec3 corner =
        spacing_ * Vec3{static_cast<double>(at[0]), static_cast<double>(at[1]), static_cast<double>(at[2])};
    const double h = spacing_;
    if (inside(at, cells_.part[cell])) {
      const Vec3 n = unit(normal), away = corner + Vec3{h / 2, h / 2, h / 2} - mean;
      mean = mean + 0.5 * (away - dot(away, n) * n);
    }
    Vec3 right;
    for (std::uint32_t s : members) {
      const Vec3 n = side(shocks_[s], reference).normal;
      right = right + (share * dot(n, shocks_[s].position - mean)) * n;
    }
    const Vec3 p = mean + solve(m, right);
    return {std::clamp(p.x, corner.x, corner.x + h), std::clamp(p.y, corner.y, corner.y + h),
            std::clamp(p.z, corner.z, corner.z + h)};
  }

  // A cell's corners, in a part.
  bool inside(const CellPlace& at, std::uint32_t part) const {
    for (int corner = 0; corner < 8; ++corner) {
      const std::uint32_t point =
          ranks_.at(at[0] + (corner & 1), at[1] + (corner >> 1 & 1), at[2] + (corner >> 2));
      if (point == LayerIndex::kOutside || parts_.of_point(point) != part) return false;
    }
    return true;
  }

  Vec3 kept_inside(std::uint32_t cell, const Vec3& wanted) const {
    if (interior_.contains(cells_.part[cell], wanted)) return wanted;
    const std::span<const std::uint32_t> members = cells_.shocks_of(cell);
    Vec3 mean, nearest = shocks_[members[0]].position;
    for (std::uint32_t s : members) {
      const Vec3& shock = shocks_[s].position;
      mean = mean + (1 / static_cast<double>(members.size())) * shock;
      if (norm(shock - wanted) < norm(nearest - wanted)) nearest = shock;
    }
    return interior_.contains(cells_.part[cell], mean) ? mean : nearest;
  }

  static void add_quad(const std::array<std::uint32_t, 4>& ring, ChordSheet& sheet) {
    const auto [a, b, c, d] = ring;
    const Vec3 ac = sheet.vertices[a].position - sheet.vertices[c].position;
    const Vec3 bd = sheet.vertices[b].position - sheet.vertices[d].position;
    if (dot(ac, ac) <= dot(bd, bd)) {
      sheet.triangles.push_back({a, b, c});
      sheet.triangles.push_back({a, c, d});
    } else {
      sheet.triangles.push_back({a, b, d});
      sheet.triangles.push_back({b, c, d});
    }
  }

  double spacing_;
  const SolidParts& parts_;
  const std::vector<ChordShock>& shocks_;
  double regularisation_;
  Matrix3 to_mesh_;  // F^-T
  ChordCells cells_;
  LayerIndex ranks_;
  PartInterior interior_;
};

void close_pinholes(const Lattice& lattice, const SolidParts& parts, const FrameField& field,
                    std::vector<ChordShock>& shocks) {
  // Closing one may leave another: each round makes the rim shorter.
  for (;;) {
    const std::vector<ChordShock> missing = pinhole_shocks(lattice, parts, field, shocks);
    if (missing.empty()) return;
    const auto old_end = static_cast<std::ptrdiff_t>(shocks.size());
    shocks.insert(shocks.end(), missing.begin(), missing.end());
    std::inplace_merge(shocks.begin(), shocks.begin() + old_end, shocks.end(), by_edge);
  }
}

// In a frame that stretches a flat solid, no turn may be as wide as that of a strong shock.
double strong_turn(const std::vector<ChordShock>& shocks, const ChordSheetOptions& options) {
  double max_turn = 0;
  for (const ChordShock& shock : shocks) max_turn = std::max(max_turn, shock.turn);
  return std::min(options.pruning.strong_turn,
                  std::max(options.min_strong_turn, options.strong_share * max_turn));
}

}  // namespace

ChordSheet chord_sheet(const Solid& solid, const Lattice& lattice, const FrameField& field,
                       const ChordSheetOptions& options) {
  for (const double share : {options.strong_share, options.min_strong_turn})
    require_within(share, 0, 1, "the shares of strong turns must lie between 0 and 1");
  if (!(options.regularisation > 0) || !std::isfinite(options.regularisation)) {
    throw CoreError(CoreError::Code::kBadInput, "the regularisation must be a finite number > 0");
  }
  const SolidParts parts(solid, lattice);
  std::vector<ChordShock> candidates = chord_shocks(lattice, field, options.shocks);
  throw_if_stopped(options.context);
  ChordTurnOptions turns = options.turns;
  turns.context = options.context;
  measure_turns(lattice, parts, field, candidates, turns);
  throw_if_stopped(options.context);
  ChordPruningOptions pruning = options.pruning;
  pruning.strong_turn = strong_turn(candidates, options);
  SignificantShocks kept = significant_shocks(lattice, parts, candidates, pruning);
  ChordSheet sheet;
  sheet.shocks = std::move(kept.shocks);
  throw_if_stopped(options.context);
  close_pinholes(lattice, parts, field, sheet.shocks);
  sheet.pieces = std::move(kept.pieces);
  sheet.bridges = kept.bridges;
  sheet.strong_turn = pruning.strong_turn;
  sheet.census = kept.census;
  Contouring(lattice, parts, sheet.shocks, options.regularisation).run(sheet, options.context);
  return sheet;
}

}  // namespace affskel::core
