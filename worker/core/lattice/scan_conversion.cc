// Notation.  g(y) are the lattice coordinates of y; a triangle is projected along the axis to (u, v); a row
// is an integer v.  An edge crosses the row when exactly one end has v' <= v (ends compared exactly).  Its u
// on the row is computed from its lower end, so both triangles of the edge get the same number.  A triangle
// covers the integers between the u of its two crossing edges, lower bound included.
#include "core/lattice/scan_conversion.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/error.h"
#include "core/base/parallel.h"

namespace affskel::core {
namespace {

// Where an edge meets a row: coordinate u, depth w, and whether it runs towards greater v.
struct RowHit {
  double u = 0, w = 0;
  bool upward = false;
};

struct Corner {
  double u = 0, v = 0, w = 0;
};

class Scanner {
 public:
  Scanner(const Mesh& mesh, const LatticeGrid& grid, int axis, unsigned threads, ExecutionContext* context)
      : mesh_(mesh), threads_(threads), context_(context), u_((axis + 1) % 3), v_((axis + 2) % 3), w_(axis) {
    u_count_ = grid.dims[static_cast<std::size_t>(u_)];
    v_count_ = grid.dims[static_cast<std::size_t>(v_)];
    transform(grid);
  }

  LineCrossings run() {
    const std::vector<std::vector<CrossingOnLine>> found = find_crossings();
    throw_if_stopped(context_);
    LineCrossings result;
    result.begin.assign(std::size_t{u_count_} * v_count_ + 1, 0);
    for (const std::vector<CrossingOnLine>& part : found) {
      for (const CrossingOnLine& f : part) ++result.begin[f.line + 1];
    }
    for (std::size_t i = 1; i < result.begin.size(); ++i) result.begin[i] += result.begin[i - 1];
    result.crossings.resize(result.begin.back());
    throw_if_stopped(context_);
    std::vector<std::uint64_t> cursor(result.begin.begin(), result.begin.end() - 1);
    for (const std::vector<CrossingOnLine>& part : found) {
      for (const CrossingOnLine& f : part) result.crossings[cursor[f.line]++] = f.crossing;
    }
    throw_if_stopped(context_);
    sort_lines(result);
    return result;
  }

  std::vector<CrossingOnLine> run_lines_met() {
    std::vector<CrossingOnLine> found;
    scan(0, static_cast<std::uint32_t>(mesh_.triangles.size()), [&](std::uint64_t line, const Crossing& c) {
      found.push_back({line, c});
    });
    std::sort(found.begin(), found.end(), [](const CrossingOnLine& a, const CrossingOnLine& b) {
      return a.line != b.line ? a.line < b.line : comes_before(a.crossing, b.crossing);
    });
    return found;
  }

 private:
  // Lattice coordinates of all vertices: rows of the inverse of the axes' matrix (Cramer).
  void transform(const LatticeGrid& grid) {
    const auto& a = grid.axes;
    const double det = dot(a[0], cross(a[1], a[2]));
    if (det == 0) refuse("the axes of the lattice are not independent");
    const std::array<Vec3, 3> rows = {cross(a[1], a[2]), cross(a[2], a[0]), cross(a[0], a[1])};
    left_handed_ = det < 0;
    coordinates_.resize(mesh_.points.size());
    parallel_ranges(threads_, coordinates_.size(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v) {
        const Vec3 q = mesh_.points[v] - grid.origin;
        coordinates_[v] = {dot(q, rows[0]) / det, dot(q, rows[1]) / det, dot(q, rows[2]) / det};
      }
    });
  }

  Corner corner(std::uint32_t vertex) const {
    const Vec3& g = coordinates_[vertex];
    return {g[u_], g[v_], g[w_]};
  }

  // The integers n with low <= n < high, cut to 0 .. count - 1, as [first, last).
  static std::array<std::int64_t, 2> integers_in(double low, double high, std::uint32_t count) {
    const double limit = count;
    return {static_cast<std::int64_t>(std::ceil(std::clamp(low, 0.0, limit))),
            static_cast<std::int64_t>(std::ceil(std::clamp(high, 0.0, limit)))};
  }

  // The crossings of all triangles, one list per thread.
  std::vector<std::vector<CrossingOnLine>> find_crossings() const {
    std::vector<std::vector<CrossingOnLine>> found(std::max(1U, threads_));
    const std::size_t count = mesh_.triangles.size();
    parallel_for(threads_, found.size(), [&](std::size_t part) {
      const auto keep = [&](std::uint64_t line, const Crossing& c) { found[part].push_back({line, c}); };
      scan(static_cast<std::uint32_t>(count * part / found.size()),
           static_cast<std::uint32_t>(count * (part + 1) / found.size()), keep);
    });
    return found;
  }

  static bool comes_before(const Crossing& a, const Crossing& b) {
    if (a.depth != b.depth) return a.depth < b.depth;
    return a.exits != b.exits ? a.exits > b.exits : a.triangle < b.triangle;
  }

  void sort_lines(LineCrossings& lines) const {
    parallel_ranges(threads_, lines.begin.size() - 1, [&](std::size_t first, std::size_t last) {
      StopCheck stop(context_);
      for (std::size_t line = first; line < last; ++line) {
        stop.did(1 + lines.begin[line + 1] - lines.begin[line]);
        std::sort(lines.crossings.data() + lines.begin[line], lines.crossings.data() + lines.begin[line + 1],
                  comes_before);
      }
    });
  }

  template <class Visit>
  void scan(std::uint32_t first, std::uint32_t last, const Visit& visit) const {
    StopCheck stop(context_);
    for (std::uint32_t t = first; t < last; ++t) {
      const Triangle& c = mesh_.triangles[t];
      const std::array<Corner, 3> p = {corner(c[0]), corner(c[1]), corner(c[2])};
      const auto rows =
          integers_in(std::min({p[0].v, p[1].v, p[2].v}), std::max({p[0].v, p[1].v, p[2].v}), v_count_);
      stop.did(1);
      for (std::int64_t row = rows[0]; row < rows[1]; ++row) stop.did(scan_row(t, p, row, visit));
    }
  }

  // Returns the number of lines that it looked at.
  template <class Visit>
  std::uint64_t scan_row(std::uint32_t t, const std::array<Corner, 3>& p, std::int64_t row,
                         const Visit& visit) const {
    std::array<RowHit, 2> hit;
    std::size_t hits = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const Corner &a = p[i], &b = p[(i + 1) % 3];
      const auto v = static_cast<double>(row);
      if ((a.v <= v) == (b.v <= v) || hits == 2) continue;
      const Corner &low = a.v < b.v ? a : b, &high = a.v < b.v ? b : a;
      const double s = (v - low.v) / (high.v - low.v);
      hit[hits++] = {low.u + s * (high.u - low.u), low.w + s * (high.w - low.w), a.v < b.v};
    }
    if (hits != 2) return 1;
    if (hit[1].u < hit[0].u) std::swap(hit[0], hit[1]);
    // Seen from the tip of the axis a triangle is counter-clockwise, hence faces up, when its right edge
    // runs towards greater v.
    const std::int32_t exits = hit[1].upward != left_handed_ ? 1 : -1;
    const auto columns = integers_in(hit[0].u, hit[1].u, u_count_);
    for (std::int64_t column = columns[0]; column < columns[1]; ++column) {
      const double s = (static_cast<double>(column) - hit[0].u) / (hit[1].u - hit[0].u);
      const double depth = hit[0].w + s * (hit[1].w - hit[0].w);
      visit(static_cast<std::uint64_t>(column) * v_count_ + static_cast<std::uint64_t>(row),
            Crossing{depth, t, exits});
    }
    return static_cast<std::uint64_t>(1 + columns[1] - columns[0]);
  }

  const Mesh& mesh_;
  unsigned threads_;
  ExecutionContext* context_;
  int u_, v_, w_;
  std::uint32_t u_count_ = 0, v_count_ = 0;
  bool left_handed_ = false;
  std::vector<Vec3> coordinates_;
};

}  // namespace

LineCrossings scan_convert(const Mesh& mesh, const LatticeGrid& grid, int axis, unsigned threads,
                           ExecutionContext* context) {
  return Scanner(mesh, grid, axis, threads, context).run();
}

std::vector<CrossingOnLine> scan_convert_lines_met(const Mesh& mesh, const LatticeGrid& grid, int axis,
                                                   ExecutionContext* context) {
  return Scanner(mesh, grid, axis, 1, context).run_lines_met();
}

}  // namespace affskel::core
