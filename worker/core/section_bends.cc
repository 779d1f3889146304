// Notation (design section 2).  d: the direction; h(y) = d.y; ranks order the vertices by height.  A triangle
// T has corners of rank lo < mid < hi at heights a <= b <= c, and p = -d.a_T, a_T its outward area vector.
// The share f_T(t) of T below t is quadratic between the heights, and A(t) = sum p_T f_T(t) is the area of
// the section, V(t) its integral.  f_T starts at a, bends at b and ends at c with f and f' continuous, so
//   f_T'' / 2 jumps by  1/((b-a)(c-a)),  -1/((b-a)(c-a)) - 1/((c-b)(c-a)),  1/((c-b)(c-a))  at a, b, c:
// per vertex only the bend of A changes.  Bends of nearly level triangles are huge and must cancel exactly
// later; they, and all running coefficients, are kept as unevaluated sums of two doubles ("hi + lo").
#include "core/section_bends.h"

#include <algorithm>
#include <cmath>

namespace affskel::core {
namespace {

// A triangle lower than this (inner units; the solid's size is 1) is a jump of A at its top, an edge a jump
// of A'.  V is exact above them and off by less than p times this inside their height range.  Smaller
// values cost accuracy too: bends reach p / kLevel^2, of which the double-double sums keep 2^-104.
constexpr double kLevel = TreeInput::kLevelHeight;
// Bends up to this times v0 are added in plain doubles: 2^-53 of it, integrated three times over the height
// of the solid (at most 1.8 inner units), is less than 1e-12 v0.
constexpr double kPlainBend = 4000;

struct Ranked {
  std::uint32_t lo, mid, hi;
};

inline Ranked sort3(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  const std::uint32_t lo = std::min(std::min(a, b), c), hi = std::max(std::max(a, b), c);
  return {lo, a ^ b ^ c ^ lo ^ hi, hi};
}

inline void add_level_triangle(const Ranked& r, double a, double b, double c, double p, SectionBends& out) {
  out.jumps.push_back({r.hi, p * (c - (a + b + c) / 3), p, {}});
}

inline void add_level_low_edge(const Ranked& r, double a, double b, double c, double p, SectionBends& out) {
  const DoubleSum bend = quotient(p, c - b, c - b);
  out.bend[r.mid].add(-bend.hi, -bend.lo);
  out.bend[r.hi].add(bend);
  out.jumps.push_back({r.mid, p * (b - a) / 3, 0, times(bend, 2 * (c - b))});
}

inline void add_level_high_edge(const Ranked& r, double a, double b, double c, double p, SectionBends& out) {
  const DoubleSum bend = quotient(p, b - a, b - a);
  out.bend[r.lo].add(bend);
  out.bend[r.mid].add(-bend.hi, -bend.lo);
  out.jumps.push_back({r.mid, -p * (c - b) / 3, 0, times(bend, -2 * (b - a))});
}

__attribute__((always_inline)) inline void add_exactly(const Ranked& r, double a, double b, double c,
                                                       double p, SectionBends& out) {
  const DoubleSum start = quotient(p, b - a, c - a), end = quotient(p, c - b, c - a);
  out.bend[r.lo].add(start);
  out.bend[r.mid].add(-start.hi, -start.lo);
  out.bend[r.mid].add(-end.hi, -end.lo);
  out.bend[r.hi].add(end);
}

void pass_triangles(const TreeInput::Data& input, const HeightOrder& heights, const Vec3& d,
                    SectionBends& out) {
  const std::vector<Triangle>& triangles = input.solid.mesh.triangles;
  const std::uint32_t* rank = heights.rank().data();
  SectionBends::Vertex* vertex = out.vertices.data();
  const double plain = kPlainBend * input.volume;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const Ranked r = sort3(rank[triangles[t][0]], rank[triangles[t][1]], rank[triangles[t][2]]);
    SectionBends::Vertex &lo = vertex[r.lo], &mid = vertex[r.mid], &hi = vertex[r.hi];
    out.lowest[t] = r.lo;
    mid.down = r.lo;
    hi.down = r.lo;
    ++mid.middles;
    const double a = lo.height, b = mid.height, c = hi.height;
    const double p = -dot(d, input.area_vector[t]);
    const double ba = b - a, cb = c - b, ca = c - a;
    const double start = p / (ba * ca), end = p / (cb * ca);
    if (std::abs(start) <= plain && std::abs(end) <= plain && ba > kLevel && cb > kLevel) {
      lo.plain_bend += start;
      mid.plain_bend -= start + end;
      hi.plain_bend += end;
    } else if (ca <= kLevel || (ba <= kLevel && cb <= kLevel)) {
      add_level_triangle(r, a, b, c, p, out);
    } else if (ba <= kLevel) {
      add_level_low_edge(r, a, b, c, p, out);
    } else if (cb <= kLevel) {
      add_level_high_edge(r, a, b, c, p, out);
    } else {
      add_exactly(r, a, b, c, p, out);
    }
  }
}

}  // namespace

void find_section_bends(const TreeInput::Data& input, const HeightOrder& heights, const Vec3& d,
                        SectionBends& out) {
  const std::vector<double>& height = heights.height();
  out.bend.assign(height.size(), {});
  out.vertices.resize(height.size());
  for (std::size_t r = 0; r < height.size(); ++r) {
    out.vertices[r] = {height[r], 0, SectionBends::kNone, 0};
  }
  out.lowest.resize(input.solid.mesh.triangles.size());
  out.jumps.clear();
  pass_triangles(input, heights, d, out);
  std::stable_sort(out.jumps.begin(), out.jumps.end(),
                   [](const Jump& a, const Jump& b) { return a.rank < b.rank; });
}

}  // namespace affskel::core
