#include "core/chord_sheet.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

#include "core/chord_cells.h"
#include "core/error.h"
#include "core/slab_index.h"

namespace affskel::core {
namespace {

// Rows of a symmetric positive definite matrix.
using Matrix = std::array<Vec3, 3>;

Vec3 solve(const Matrix& m, const Vec3& b) {
  const Vec3 c0 = cross(m[1], m[2]), c1 = cross(m[2], m[0]), c2 = cross(m[0], m[1]);
  return (1 / dot(m[0], c0)) * (b.x * c0 + (b.y * c1 + b.z * c2));
}

Vec3 unit(const Vec3& v) {
  const double length = norm(v);
  return length > 0 ? (1 / length) * v : Vec3{};
}

// |grad_x E| = |F^-T g| for a gradient g in the frame: the area of the section.
class SectionArea {
 public:
  explicit SectionArea(const Lattice& lattice) {
    const std::array<Vec3, 3> f = frame_matrix(lattice);
    const double scale = 1 / dot(f[0], cross(f[1], f[2]));
    for (std::size_t k = 0; k < 3; ++k) columns_[k] = scale * cross(f[(k + 1) % 3], f[(k + 2) % 3]);
  }

  double operator()(const Vec3& g) const {
    return norm(g.x * columns_[0] + (g.y * columns_[1] + g.z * columns_[2]));
  }

 private:
  std::array<Vec3, 3> columns_;
};

class Contouring {
 public:
  Contouring(const Lattice& lattice, const std::vector<ChordShock>& shocks, double regularisation)
      : spacing_(lattice.spacing),
        shocks_(shocks),
        regularisation_(regularisation),
        area_(lattice),
        cells_(chord_cells(lattice, shocks)),
        slabs_(lattice) {}

  void run(ChordSheet& sheet) {
    sheet.vertices.reserve(cells_.size());
    std::int64_t reached = -1;
    for (std::uint32_t cell = 0; cell < cells_.size(); ++cell) {
      while (reached < cells_.place[cell][0]) slabs_.move_to(static_cast<std::uint32_t>(++reached));
      sheet.vertices.push_back(vertex(cell));
    }
    for (const auto& ring : cells_.ring) add_quad(ring, sheet);
  }

 private:
  // One shock of a cell as the others see it: normal and sides turned to agree with the first one's.
  struct Side {
    Vec3 normal, gradient_a, gradient_b;
  };

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
    v.position = place(cell, reference);
    for (std::uint32_t s : members) {
      const ChordShock& shock = shocks_[s];
      const Side seen = side(shock, reference);
      // In the sheet both branches change alike, so their mean gradient leads from the shock to the vertex.
      const Vec3 slope = 0.5 * (shock.gradient_low + shock.gradient_high);
      v.erosion += share * (shock.erosion + dot(slope, v.position - shock.position));
      v.strength += share * shock.strength;
      v.area += share * 0.5 * (area_(shock.gradient_low) + area_(shock.gradient_high));
      v.normal_a = v.normal_a + unit(seen.gradient_a);
      v.normal_b = v.normal_b + unit(seen.gradient_b);
    }
    v.erosion = std::max(v.erosion, 0.0);
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
    if (inside(at)) {
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

  bool inside(const CellPlace& at) const {
    for (int corner = 0; corner < 8; ++corner) {
      if (slabs_.at(at[0] + (corner & 1), at[1] + (corner >> 1 & 1), at[2] + (corner >> 2)) ==
          SlabIndex::kOutside) {
        return false;
      }
    }
    return true;
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
  const std::vector<ChordShock>& shocks_;
  double regularisation_;
  SectionArea area_;
  ChordCells cells_;
  SlabIndex slabs_;
};

}  // namespace

ChordSheet chord_sheet(const Lattice& lattice, const FrameField& field, const ChordSheetOptions& options) {
  if (!(options.regularisation > 0) || !std::isfinite(options.regularisation)) {
    throw CoreError(CoreError::Code::kBadInput, "the regularisation must be a finite number > 0");
  }
  SignificantShocks kept =
      significant_shocks(lattice, chord_shocks(lattice, field, options.shocks), options.pruning);
  ChordSheet sheet;
  sheet.shocks = std::move(kept.shocks);
  sheet.pieces = std::move(kept.pieces);
  Contouring(lattice, sheet.shocks, options.regularisation).run(sheet);
  return sheet;
}

}  // namespace affskel::core
