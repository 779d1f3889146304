#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "core/base/disjoint_sets.h"
#include "core/curve/curve_graph.h"
#include "core/curve/curve_skeleton.h"
#include "core/mesh/box.h"
#include "core/mesh/perturb.h"
#include "core/quality/similarity.h"
#include "experiments.h"
#include "job.h"
#include "limb_ends.h"
#include "limbed_solids.h"

namespace affskel::experiments {
namespace {

constexpr double kNoise = 0.01;   // of the diagonal
constexpr double kLongLimb = 5;   // radii: noise as large as fingers and feet leaves these
constexpr double kVoxels = 128;   // along the longest side
constexpr double kLeastSame = 7;  // of eight

// The lines of the largest piece: where noise makes the surface cross itself, it cuts off hands.
struct Lines {
  std::vector<core::Vec3> places;  // along all of them
  std::vector<core::CurveBranch> limbs;
  std::uint32_t links = 0, others = 0;

  std::string text() const { return format("%zu, %u, %u", limbs.size(), links, others); }
};

// Per node: the first of its piece.
std::vector<std::uint32_t> pieces_of(const core::CurveGraph& graph) {
  core::DisjointSets pieces(graph.nodes.size());
  for (const core::CurveBranch& branch : graph.branches) pieces.unite(branch.from, branch.to);
  std::vector<std::uint32_t> first;
  for (std::uint32_t node = 0; node < graph.nodes.size(); ++node) first.push_back(pieces.find(node));
  return first;
}

Lines lines_of(const Job& job) {
  const core::CurveSkeleton curve = curve_of(job, {.least_reach = kLongLimb});
  const std::vector<core::Vec3> places = places_of(job, curve);
  Lines found;
  found.places = points_along(places, curve.segments, job.lattice.spacing);
  const core::CurveGraph graph = core::curve_graph(places, curve.segments, curve.radius, curve.share);
  const std::vector<std::uint32_t> piece = pieces_of(graph);
  std::map<std::uint32_t, double> share;
  for (const core::CurveBranch& branch : graph.branches) share[piece[branch.from]] += branch.share;
  const auto largest = std::ranges::max_element(share, {}, [](const auto& one) { return one.second; })->first;
  for (const core::CurveBranch& branch : graph.branches) {
    if (piece[branch.from] != largest) continue;
    if (branch.kind == core::BranchKind::kLimb)
      found.limbs.push_back(branch);
    else
      ++(branch.kind == core::BranchKind::kLink ? found.links : found.others);
  }
  return found;
}

// By how much lengths and shares of limbs differ at most, percent.
double greatest_change(const Lines& one, const Lines& other) {
  double most = 0;
  for (std::size_t n = 0; n < one.limbs.size(); ++n) {
    for (const auto value : {&core::CurveBranch::length, &core::CurveBranch::share})
      most = std::max(most, 100 * std::abs(other.limbs[n].*value / (one.limbs[n].*value) - 1));
  }
  return most;
}

void study(const NamedMesh& body, const Setting& setting, Table& table, Report& report) {
  const double radius = std::sqrt(3.0) * core::box_of(body.mesh).longest_side() / kVoxels;
  const JobOptions options = comparison_options(body.mesh, setting);
  const Lines clean = lines_of(compute(body.mesh, options));
  std::string other;
  std::uint32_t same = 0;
  double there = 0, back = 0, change = 0;
  for (std::uint64_t seed = 1; seed <= setting.seeds; ++seed) {
    const Lines noisy =
        lines_of(compute(core::perturb(body.mesh, {kNoise * core::box_diagonal(body.mesh), seed}), options));
    const core::Similarity alike = core::similarity(clean.places, noisy.places);
    there += 100 * alike.b_in_a.share_within(radius) / setting.seeds;
    back += 100 * alike.a_in_b.share_within(radius) / setting.seeds;
    if (noisy.text() == clean.text()) {
      ++same;
      change = std::max(change, greatest_change(clean, noisy));
    } else {
      other += (other.empty() ? "" : "; ") + noisy.text();
    }
  }
  table.rows.push_back({body.name, clean.text(), format("%u of %u", same, setting.seeds), other,
                        format("%.0f / %.0f", there, back), format("%.0f", change)});
  // Noise is larger than the triangles of the other one.
  if (!setting.quick && setting.meshes.empty() && body.mesh.triangles.size() <= 1000)
    report.expect(body.name + ": seeds of eight with the same lines", 8.0 * same / setting.seeds, kLeastSame,
                  8);
}

}  // namespace

void graph_experiment(const Setting& setting, Report& report) {
  report.section("Lines of limbs under noise");
  report.text(
      "Not published: at 100,000 points, noise of 1 % of the diagonal, as large as fingers and feet: the limbs, links and other "
      "lines that the largest piece of the curve skeleton has at the threshold 5, which leaves out what is shorter than five of "
      "its radii; of how many seeds it has the same, and what the others have; which share of the lines, in percent, is within "
      "the diagonal of a voxel of 1/128 of the longest side of the clean ones', and back; and by how much the length or the "
      "volume of a limb differs at most, percent, where lines are the same.");
  Table table{{"body", "limbs, links, others", "the same", "else", "there / back", "greatest change"}, {}};
  for (const NamedMesh& body : bodies_to_compare(setting)) study(body, setting, table, report);
  report.table(table);
}

}  // namespace affskel::experiments
