#include "core/ridge/round_sheet.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include "core/base/disjoint_sets.h"
#include "core/ridge/curve_feet.h"
#include "core/ridge/round_stretches.h"

namespace affskel::core {
namespace {

constexpr int kPlacesOfJoint = 16;  // parts of a joint, between which it is asked whether it is in the solid

bool long_enough(const RidgeCurve& curve, const RidgeConstants& constants) {
  if (std::all_of(curve.vertices.begin(), curve.vertices.end(),
                  [&](const SheetVertex& v) { return v.ratio >= constants.round_ratio; }))
    return true;
  const double sum = std::accumulate(curve.radius.begin(), curve.radius.end(), 0.0);
  return curve_length(curve) * static_cast<double>(curve.radius.size()) >= constants.min_length * sum;
}

// The parts of all stretches whose vertices are wanted.
std::vector<RidgeCurve> parts_of(std::span<const RidgeCurve> stretches, const std::vector<char>& wanted) {
  std::vector<RidgeCurve> result;
  auto begin = wanted.begin();
  for (const RidgeCurve& stretch : stretches) {
    const auto end = begin + static_cast<std::ptrdiff_t>(stretch.vertices.size());
    for (RidgeCurve& part : parts_of_curve(stretch, {begin, end})) result.push_back(std::move(part));
    begin = end;
  }
  return result;
}

// The stretches without the places where the sheet is wide.
std::vector<RidgeCurve> narrow_only(const SheetMesh& mesh, std::span<const RidgeCurve> stretches,
                                    const RidgeConstants& constants) {
  const std::vector<CurveVertex> curve = curve_vertices(stretches);
  const std::vector<CurveFoot> feet = curve_feet(mesh, curve, constants.reach);
  std::vector<char> wanted(curve.size(), 1);
  for (const Triangle& t : mesh.triangles) {
    bool crosses = false;
    for (const std::uint32_t corner : t) crosses = crosses || feet[corner].sideways;
    if (!crosses) continue;
    for (const std::uint32_t corner : t)
      if (feet[corner].place == CurveFoot::Place::kBeside) wanted[feet[corner].vertex] = 0;
  }
  std::vector<RidgeCurve> result = parts_of(stretches, wanted);
  std::erase_if(result, [&](const RidgeCurve& part) { return !long_enough(part, constants); });
  return result;
}

class Replacement {
 public:
  Replacement(SheetMesh& mesh, std::vector<RidgeCurve> stretches, double reach)
      : mesh_(mesh),
        stretches_(std::move(stretches)),
        reach_(reach),
        curve_(curve_vertices(stretches_)),
        feet_(curve_feet(mesh, curve_, reach)),
        replaced_(stretches_.size(), 0),
        pieces_(mesh.vertices.size()) {}

  // What is removed, and where curves are joined; the mesh stays as it is.
  // @return per stretch: whether it has a place that only joints outside the solid could join.
  std::vector<char> plan(const std::function<bool(const Vec3&)>& inside) {
    remove_triangles();
    std::vector<char> cut_off = find_joints(inside);
    drop_leftovers();
    return cut_off;
  }

  std::uint32_t carry_out() {
    std::uint32_t count = 0;
    for (std::uint32_t s = 0, first = 0; s < stretches_.size(); ++s) {
      if (replaced_[s]) {
        add_curve(s, first);
        ++count;
      }
      first += static_cast<std::uint32_t>(stretches_[s].vertices.size());
    }
    mesh_.triangles = std::move(kept_);
    drop_unused_vertices(mesh_);
    return count;
  }

 private:
  struct Joint {
    double length;
    std::uint32_t sheet, curve;  // vertices
    friend auto operator<=>(const Joint&, const Joint&) = default;
  };

  std::uint32_t stretch_of(std::uint32_t vertex) const { return curve_[feet_[vertex].vertex].stretch; }

  void remove_triangles() {
    border_.assign(mesh_.vertices.size(), 0);
    for (const Triangle& t : mesh_.triangles) {
      if (is_beside(feet_, curve_, t)) {
        replaced_[stretch_of(t[0])] = 1;
        for (const std::uint32_t corner : t) border_[corner] = 1;
      } else {
        kept_.push_back(t);
        pieces_.unite(t[0], t[1]);
        pieces_.unite(t[0], t[2]);
      }
    }
  }

  // Pieces within the reach of one stretch that was put in, unless they join two places of it.
  void drop_leftovers() {
    constexpr std::uint32_t kMany = kNoVertex - 1;
    std::vector<std::uint32_t> beside(mesh_.vertices.size(), kNoVertex);  // per piece: the stretch, or kMany
    for (const Triangle& t : kept_) {
      for (const std::uint32_t corner : t) {
        const bool near = feet_[corner].vertex != kNoVertex && replaced_[stretch_of(corner)];
        const std::uint32_t here = near ? stretch_of(corner) : kMany;
        std::uint32_t& known = beside[pieces_.find(corner)];
        known = known == kNoVertex || known == here ? here : kMany;
      }
    }
    std::vector<std::uint32_t> joints(mesh_.vertices.size(), 0);  // per piece
    for (const Joint& joint : joints_) ++joints[pieces_.find(joint.sheet)];
    const auto dropped = [&](std::uint32_t vertex) {
      const std::uint32_t piece = pieces_.find(vertex);
      return beside[piece] != kMany && joints[piece] < 2;
    };
    std::erase_if(kept_, [&](const Triangle& t) { return dropped(t[0]); });
    std::erase_if(joints_, [&](const Joint& joint) { return dropped(joint.sheet); });
  }

  bool stays_inside(const Joint& joint, const std::function<bool(const Vec3&)>& inside) const {
    const Vec3 &from = mesh_.vertices[joint.sheet].position, &to = curve_[joint.curve].position;
    for (int k = 1; k < kPlacesOfJoint; ++k) {
      if (!inside(from + (static_cast<double>(k) / kPlacesOfJoint) * (to - from))) return false;
    }
    return true;
  }

  std::vector<char> find_joints(const std::function<bool(const Vec3&)>& inside) {
    std::vector<char> used(mesh_.vertices.size(), 0);
    for (const Triangle& t : kept_)
      for (const std::uint32_t corner : t) used[corner] = 1;
    std::vector<Joint> candidates, outside;
    for (std::uint32_t v = 0; v < used.size(); ++v) {
      if (!used[v] || !border_[v]) continue;
      const std::uint32_t foot = feet_[v].vertex;
      candidates.push_back({norm(mesh_.vertices[v].position - curve_[foot].position), v, foot});
    }
    std::sort(candidates.begin(), candidates.end());
    const auto is_joined = [&](const Joint& place) {
      return std::any_of(joints_.begin(), joints_.end(),
                         [&](const Joint& j) { return same_place(j, place); });
    };
    for (const Joint& joint : candidates) {
      if (!is_joined(joint)) (stays_inside(joint, inside) ? joints_ : outside).push_back(joint);
    }
    std::vector<char> cut_off(stretches_.size(), 0);
    for (const Joint& joint : outside) {
      if (!is_joined(joint)) cut_off[curve_[joint.curve].stretch] = 1;
    }
    return cut_off;
  }

  // Whether two joints join the same stretch and piece at about the same place.
  bool same_place(const Joint& a, const Joint& b) {
    const CurveVertex &at_a = curve_[a.curve], &at_b = curve_[b.curve];
    if (at_a.stretch != at_b.stretch || pieces_.find(a.sheet) != pieces_.find(b.sheet)) return false;
    const double near = reach_ * (at_a.radius + at_b.radius),
                 half = 0.5 * curve_length(stretches_[at_a.stretch]);
    return std::abs(at_a.arc - at_b.arc) <= std::min(near, half);
  }

  // Puts in the stretch whose vertices begin at `first`, between its outermost joints.
  void add_curve(std::uint32_t s, std::uint32_t first) {
    const RidgeCurve& stretch = stretches_[s];
    std::uint32_t begin = first, last = first + static_cast<std::uint32_t>(stretch.vertices.size()) - 1;
    if (!stretch.closed) {
      const std::uint32_t front = begin, back = last;
      const auto near_end = [&](std::uint32_t v, std::uint32_t end) {
        return std::abs(curve_[v].arc - curve_[end].arc) <= reach_ * curve_[end].radius;
      };
      std::uint32_t from = kNoVertex, to = kNoVertex;
      for (const Joint& joint : joints_) {
        if (curve_[joint.curve].stretch != s) continue;
        if (near_end(joint.curve, front)) from = std::min(from, joint.curve);
        if (near_end(joint.curve, back)) to = to == kNoVertex ? joint.curve : std::max(to, joint.curve);
      }
      if (from != kNoVertex) begin = from;
      if (to != kNoVertex && to >= begin) last = to;
    }
    const auto base = static_cast<std::uint32_t>(mesh_.vertices.size());
    for (std::uint32_t v = begin; v <= last; ++v) {
      mesh_.vertices.push_back(stretch.vertices[v - first]);
      mesh_.part.push_back(stretch.part);
      if (v > begin) mesh_.segments.push_back({base + v - begin - 1, base + v - begin});
    }
    if (stretch.closed) mesh_.segments.push_back({base, base + last - begin});
    for (const Joint& joint : joints_)
      if (curve_[joint.curve].stretch == s)
        mesh_.segments.push_back({joint.sheet, base + std::clamp(joint.curve, begin, last) - begin});
  }

  SheetMesh& mesh_;
  std::vector<RidgeCurve> stretches_;
  double reach_;
  std::vector<CurveVertex> curve_;
  std::vector<CurveFoot> feet_;  // per vertex of the mesh
  std::vector<char> replaced_;   // per stretch: triangles belong to it
  DisjointSets pieces_;          // of what is kept, by vertices of the mesh
  std::vector<Triangle> kept_;
  std::vector<char> border_;  // per vertex: of a triangle that was removed
  std::vector<Joint> joints_;
};

}  // namespace

std::uint32_t put_curves(SheetMesh& mesh, std::span<const RidgeCurve> stretches,
                         const std::function<bool(const Vec3&)>& inside, const RidgeConstants& constants) {
  std::vector<RidgeCurve> wanted = narrow_only(mesh, stretches, constants);
  for (;;) {
    Replacement replacement(mesh, wanted, constants.reach);
    const std::vector<char> cut_off = replacement.plan(inside);
    if (std::find(cut_off.begin(), cut_off.end(), 1) == cut_off.end()) return replacement.carry_out();
    std::vector<RidgeCurve> staying;
    for (std::size_t s = 0; s < wanted.size(); ++s)
      if (!cut_off[s]) staying.push_back(std::move(wanted[s]));
    wanted = std::move(staying);
  }
}

}  // namespace affskel::core
