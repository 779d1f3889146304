#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "core/base/disjoint_sets.h"
#include "core/base/none.h"
#include "core/curve/curve_graph.h"
#include "core/curve/curve_skeleton.h"
#include "core/curve/limb_sections.h"
#include "core/mesh/box.h"
#include "core/mesh/perturb.h"
#include "core/quality/similarity.h"
#include "core/solid/solid_membership.h"
#include "core/spatial/point_index.h"
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

// A stretch of a line, and how thick the limb is there.
struct Station {
  core::Vec3 from, to;
  double radius = 0;
};

// The lines of the largest piece: where noise makes the surface cross itself, it cuts off hands.
struct Lines {
  std::vector<core::Vec3> places;  // along all of them
  std::vector<Station> stations;
  std::vector<core::CurveBranch> limbs;
  std::uint32_t links = 0, others = 0;
  std::vector<core::Vec3> middles;           // of limbs
  std::vector<double> volumes;               // of limbs, mesh units cubed
  std::vector<core::Vec3> points;            // all sample points
  std::vector<std::uint32_t> limb_of_point;  // per sample point: its limb; kNone of others
  double volume_of_point = 0;

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
  for (const auto& [a, b] : curve.segments)
    found.stations.push_back({places[a], places[b], std::max(curve.radius[a], curve.radius[b])});
  const core::CurveGraph graph = core::curve_graph(places, curve.segments, curve.radius, curve.share);
  const std::vector<std::uint32_t> piece = pieces_of(graph);
  std::map<std::uint32_t, double> share;
  for (const core::CurveBranch& branch : graph.branches) share[piece[branch.from]] += branch.share;
  const auto largest = std::ranges::max_element(share, {}, [](const auto& one) { return one.second; })->first;
  std::vector<std::uint32_t> number(graph.branches.size(), core::kNone);
  for (std::size_t n = 0; n < graph.branches.size(); ++n) {
    const core::CurveBranch& branch = graph.branches[n];
    if (piece[branch.from] != largest) continue;
    if (branch.kind == core::BranchKind::kLimb) {
      number[n] = static_cast<std::uint32_t>(found.limbs.size());
      found.limbs.push_back(branch);
      found.middles.push_back(places[branch.vertices[branch.vertices.size() / 2]]);
      found.volumes.push_back(branch.share * job.solid.volume);
    } else {
      ++(branch.kind == core::BranchKind::kLink ? found.links : found.others);
    }
  }
  found.points = all_points(job).place;
  for (const std::uint32_t vertex : curve.nearest) found.limb_of_point.push_back(number[graph.part[vertex]]);
  found.volume_of_point = job.solid.volume / static_cast<double>(found.points.size());
  return found;
}

// Of limbs that are the same, by how much they differ at most, percent.
struct Change {
  double length = 0;
  double volume = 0;    // as measured
  double solid = 0;     // of what the solid has in the place of the clean limb
  double measured = 0;  // of the volume beside that: what is the measure's own
};

void take(double value, double of, double& most) {
  most = std::max(most, 100 * std::abs(value / of - 1));
}

// Limbs are the same whose middles are nearest.
void compare(const Lines& clean, const Lines& noisy, Change& most) {
  const core::PointIndex points(clean.points), middles(noisy.middles);
  std::vector<double> there(clean.limbs.size(), 0);
  for (const core::Vec3& point : noisy.points)
    if (const std::uint32_t limb = clean.limb_of_point[points.find(point).number]; limb != core::kNone)
      there[limb] += noisy.volume_of_point;
  for (std::size_t n = 0; n < clean.limbs.size(); ++n) {
    const std::size_t same = middles.find(clean.middles[n]).number;
    take(noisy.limbs[same].length, clean.limbs[n].length, most.length);
    take(noisy.volumes[same], clean.volumes[n], most.volume);
    take(there[n], clean.volumes[n], most.solid);
    take(noisy.volumes[same], there[n], most.measured);
  }
}

// Which share of the clean solid's sections, at right angles to its lines, has its centroid within the radius of where it was,
// percent: lines in the middle of the solid do not stay where that goes.
double sections_that_stay(const Lines& clean, const core::Mesh& before, const core::Mesh& after,
                          double radius) {
  const core::LimbSections were(before), are(after);
  const core::SolidMembership solid(after);
  double all = 0, stay = 0;
  for (const auto& [from, to, ball] : clean.stations) {
    const core::Vec3 place = 0.5 * (from + to), along = to - from;
    const double length = norm(along);
    if (length == 0 || solid.winding_number(place) <= 0) continue;
    const core::Vec3 across = (1 / length) * along;
    all += length;
    if (norm(are.at(place, across, ball).centre - were.at(place, across, ball).centre) <= radius)
      stay += length;
  }
  return all > 0 ? 100 * stay / all : 100;
}

void study(const NamedMesh& body, const Setting& setting, Table& table, Report& report) {
  const double radius = std::sqrt(3.0) * core::box_of(body.mesh).longest_side() / kVoxels;
  const JobOptions options = comparison_options(body.mesh, setting);
  const Lines clean = lines_of(compute(body.mesh, options));
  std::string other;
  std::uint32_t same = 0;
  double there = 0, back = 0, sections = 0;
  Change change;
  for (std::uint64_t seed = 1; seed <= setting.seeds; ++seed) {
    const core::Mesh mesh = core::perturb(body.mesh, {kNoise * core::box_diagonal(body.mesh), seed});
    const Lines noisy = lines_of(compute(mesh, options));
    sections += sections_that_stay(clean, body.mesh, mesh, radius) / setting.seeds;
    const core::Similarity alike = core::similarity(clean.places, noisy.places);
    there += 100 * alike.b_in_a.share_within(radius) / setting.seeds;
    back += 100 * alike.a_in_b.share_within(radius) / setting.seeds;
    if (noisy.text() == clean.text()) {
      ++same;
      compare(clean, noisy, change);
    } else {
      other += (other.empty() ? "" : "; ") + noisy.text();
    }
  }
  table.rows.push_back({body.name, clean.text(), format("%u of %u", same, setting.seeds), other,
                        format("%.0f / %.0f", there, back), format("%.0f", sections),
                        format("%.0f", change.length), format("%.0f", change.volume),
                        format("%.0f", change.solid), format("%.0f", change.measured)});
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
      "the diagonal of a voxel of 1/128 of the longest side of the clean ones', and back; which share of the solid's own sections "
      "across the clean lines has its centroid within that of where it was; and, where lines are the same, by how "
      "much at most, in percent, the length and the volume of a limb differ, what the noisy solid itself has in the place of "
      "the clean limb differs from that, and the limb's volume from what the solid has there.");
  Table table{{"body", "limbs, links, others", "the same", "else", "there / back", "sections", "length",
               "volume", "the solid's there", "volume beside that"},
              {}};
  for (const NamedMesh& body : bodies_to_compare(setting)) study(body, setting, table, report);
  report.table(table);
}

}  // namespace affskel::experiments
