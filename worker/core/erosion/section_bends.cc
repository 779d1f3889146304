// Notation (see README.md in worker/core).  d: the direction; h(y) = d.y; ranks order the vertices by height.
// A triangle T has corners of rank lo < mid < hi at heights a <= b <= c, and p = -d.a_T, a_T its outward area
// vector. The share f_T(t) of T below t is quadratic between the heights, and A(t) = sum p_T f_T(t) is the
// area of the section, V(t) its integral.  f_T starts at a, bends at b and ends at c with f and f'
// continuous, so
//   f_T'' / 2 jumps by  1/((b-a)(c-a)),  -1/((b-a)(c-a)) - 1/((c-b)(c-a)),  1/((c-b)(c-a))  at a, b, c:
// per vertex only the bend of A changes.  Bends of nearly level triangles are huge and must cancel exactly
// later.  Every bend is split into a multiple of a unit near v0, of which doubles hold sums exactly, and a
// rest of at most half of that, whose sums are off by 2^-53 v0; running coefficients are kept as unevaluated
// sums of two doubles ("hi + lo").
#include "core/erosion/section_bends.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace affskel::core {
namespace {

// A triangle lower than this (scaled units; the solid's size is 1) is a jump of A at its top, an edge a jump
// of A'.  V is exact above them and off by less than p times this inside their height range.  Smaller
// values cost accuracy too: bends reach p / kLevel^2, of which the double-double sums keep 2^-104.
constexpr double kLevel = TreeInput::kLevelHeight;
// Bends up to this times v0 may be as a division rounds them.  What a triangle adds at its start it takes
// away b - a higher, equally rounded, so that V is off by less than 2^-53 of this times b - a: were b - a the
// whole height of the solid, 2e-10 v0; where a bend is as large, b - a is a hundredth and less.
constexpr double kMaxPlainBend = 1 << 20;

using Vertex = SectionBends::Vertex;
using Link = SectionBends::Link;
using Pair = SectionBends::Pair;

struct Corners {
  const Vertex &lo, &mid, &hi;
  Link &lo_link, &mid_link, &hi_link;
};

void add_steeply(SectionBends& out, Link& link, const DoubleSum& bend) {
  if (link.steep == kNone) {
    link.steep = static_cast<std::uint32_t>(out.steep_bend.size());
    out.steep_bend.emplace_back();
  }
  out.steep_bend[link.steep].add(bend);
}

DoubleSum negative(const DoubleSum& s) {
  return {-s.hi, -s.lo};
}

void add_level_triangle(const Corners& at, double p, SectionBends& out) {
  const double a = at.lo.height, b = at.mid.height, c = at.hi.height;
  out.jumps.push_back({at.hi.rank, p * (c - (a + b + c) / 3), p, {}});
}

void add_level_low_edge(const Corners& at, double p, SectionBends& out) {
  const double a = at.lo.height, b = at.mid.height, c = at.hi.height;
  const DoubleSum bend = quotient(p, c - b, c - b);
  add_steeply(out, at.mid_link, negative(bend));
  add_steeply(out, at.hi_link, bend);
  out.jumps.push_back({at.mid.rank, p * (b - a) / 3, 0, times(bend, 2 * (c - b))});
}

void add_level_high_edge(const Corners& at, double p, SectionBends& out) {
  const double a = at.lo.height, b = at.mid.height, c = at.hi.height;
  const DoubleSum bend = quotient(p, b - a, b - a);
  add_steeply(out, at.lo_link, bend);
  add_steeply(out, at.mid_link, negative(bend));
  out.jumps.push_back({at.mid.rank, -p * (c - b) / 3, 0, times(bend, -2 * (b - a))});
}

void add_exactly(const Corners& at, double p, SectionBends& out) {
  const double a = at.lo.height, b = at.mid.height, c = at.hi.height;
  const DoubleSum start = quotient(p, b - a, c - a), end = quotient(p, c - b, c - a);
  add_steeply(out, at.lo_link, start);
  add_steeply(out, at.mid_link, negative(start));
  add_steeply(out, at.mid_link, negative(end));
  add_steeply(out, at.hi_link, end);
}

// For most directions few triangles need this, for some directions all.
__attribute__((noinline)) void add_nearly_level(const Corners& at, double p, SectionBends& out) {
  const bool low = at.mid.height - at.lo.height <= kLevel, high = at.hi.height - at.mid.height <= kLevel;
  if (at.hi.height - at.lo.height <= kLevel || (low && high)) {
    add_level_triangle(at, p, out);
  } else if (low) {
    add_level_low_edge(at, p, out);
  } else if (high) {
    add_level_high_edge(at, p, out);
  } else {
    add_exactly(at, p, out);
  }
}

// Without a branch, for the processor could not predict which of two is the lower.
inline void put_in_order(std::uint64_t& a, std::uint64_t& b) {
  const std::uint64_t change = (a ^ b) & (std::uint64_t{0} - static_cast<std::uint64_t>(b < a));
  a ^= change;
  b ^= change;
}

// The corners in the order of their ranks.
inline std::array<std::uint32_t, 3> by_rank(const Triangle& t, const Vertex* vertex) {
  const auto key = [&](std::size_t i) { return std::uint64_t{vertex[t[i]].rank} << 32 | t[i]; };
  std::uint64_t a = key(0), b = key(1), c = key(2);
  put_in_order(a, b);
  put_in_order(b, c);
  put_in_order(a, b);
  return {static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b), static_cast<std::uint32_t>(c)};
}

void pass_triangles(const TreeInput& input, const Vec3& d, SectionBends& out) {
  const std::span<const Triangle> triangles = input.mesh.triangles;
  const Vec3* area_vector = input.area_vector.data();
  std::uint32_t* lowest = out.lowest.data();
  Vertex* vertex = out.vertices.data();
  Link* link = out.links.data();
  const double most = kMaxPlainBend * input.volume;
  // Adding and taking away 1.5 * 2^52 units rounds to units.
  const double unit = std::ldexp(1.5, 52 + std::ilogb(input.volume));
  const Pair rounder = {unit, unit};
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const std::array<std::uint32_t, 3> corner = by_rank(triangles[t], vertex);
    Vertex &lo = vertex[corner[0]], &mid = vertex[corner[1]], &hi = vertex[corner[2]];
    lowest[t] = corner[0];
    mid.down = corner[0];
    hi.down = corner[0];
    ++link[corner[1]].middles;
    const double p = -dot(d, area_vector[t]);
    const double ba = mid.height - lo.height, cb = hi.height - mid.height, ca = hi.height - lo.height;
    const double flattest = std::min(ba, cb);
    if (!(std::abs(p) <= most * (flattest * ca) && flattest > kLevel)) {
      add_nearly_level({lo, mid, hi, link[corner[0]], link[corner[1]], link[corner[2]]}, p, out);
      continue;
    }
    const Pair bends = Pair{p, p} / (Pair{ba, cb} * Pair{ca, ca});  // at the start, at the end
    const Pair coarse = (bends + rounder) - rounder, fine = bends - coarse;
    lo.bend += Pair{coarse[0], fine[0]};
    mid.bend -= Pair{coarse[0] + coarse[1], fine[0] + fine[1]};
    hi.bend += Pair{coarse[1], fine[1]};
  }
}

}  // namespace

void find_section_bends(const TreeInput& input, const HeightOrder& heights, const Vec3& d,
                        SectionBends& out) {
  const std::vector<std::uint32_t>& order = heights.order();
  out.vertices.resize(order.size());
  for (std::uint32_t r = 0; r < order.size(); ++r) {
    out.vertices[order[r]] = {.height = heights.height()[r], .rank = r};
  }
  out.links.assign(order.size(), {});
  out.lowest.resize(input.mesh.triangles.size());
  out.steep_bend.clear();
  out.jumps.clear();
  pass_triangles(input, d, out);
  std::stable_sort(out.jumps.begin(), out.jumps.end(),
                   [](const Jump& a, const Jump& b) { return a.rank < b.rank; });
}

}  // namespace affskel::core
