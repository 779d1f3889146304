// E and its ridge on one solid in several tessellations, over the mesh's normals and over all directions; and how
// sets of directions come near to the infimum.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "core/quality/similarity.h"
#include "curvature_skeleton.h"
#include "experiments.h"
#include "fields.h"
#include "job.h"
#include "sheet.h"

namespace affskel::experiments {
namespace {

constexpr double kRadius = 250;  // mesh units, within which skeletons are alike: 1/72 of the body's height

// E over that of another field, ascending, at the places that both have.
std::vector<double> ratios(const Values& some, const Values& others) {
  std::vector<double> found;
  for (const auto& [place, erosion] : some) {
    const auto other = others.find(place);
    if (other != others.end()) found.push_back(erosion / other->second);
  }
  std::ranges::sort(found);
  return found;
}

// What lies in one of two solids and not in the other, over the volume of the second, by sample points.
double share_apart(const Values& some, const Values& others) {
  const auto both = std::ranges::count_if(some, [&](const auto& v) { return others.contains(v.first); });
  return (static_cast<double>(some.size() + others.size()) - 2 * static_cast<double>(both)) /
         static_cast<double>(others.size());
}

std::vector<double> changes(std::vector<double> ratio) {
  for (double& r : ratio) r = 1 + std::abs(r - 1);
  std::ranges::sort(ratio);
  return ratio;
}

double excess_at(const std::vector<double>& sorted, double share) {
  return sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1))] - 1;
}

std::string percent(double share) {
  return format("%.2g %%", 100 * share);
}

std::string alike(const std::vector<core::Vec3>& clean, const std::vector<core::Vec3>& other) {
  const core::Similarity s = core::similarity(clean, other);
  return format("%.0f / %.0f", 100 * s.b_in_a.share_within(kRadius), 100 * s.a_in_b.share_within(kRadius));
}

core::Mesh with_triangles_in_three(const core::Mesh& mesh) {
  core::Mesh finer{mesh.points, {}};
  for (const core::Triangle& t : mesh.triangles) {
    const auto middle = static_cast<std::uint32_t>(finer.points.size());
    finer.points.push_back((1.0 / 3) * (mesh.points[t[0]] + mesh.points[t[1]] + mesh.points[t[2]]));
    for (std::size_t k = 0; k < 3; ++k) finer.triangles.push_back({t[k], t[(k + 1) % 3], middle});
  }
  return finer;
}

// What is compared of a tessellation.
struct Tessellation {
  std::string name;
  double volume = 0;
  Values set, infimum;
  std::vector<core::Vec3> set_ridge, infimum_ridge, curvature;
};

Tessellation study(std::string name, const core::Mesh& mesh, const Grid& grid, unsigned threads) {
  const Fields set(mesh, grid, "triangles", threads);
  Fields infimum(mesh, grid, kSeeds, threads);
  infimum.go_on();
  return {std::move(name),
          set.job().solid.volume,
          set.erosion(),
          infimum.erosion(),
          ridge_sheet_of(set.job()).points.place,
          ridge_sheet_of(infimum.job()).points.place,
          curvature_skeleton(mesh).points};
}

void compare_tessellations(const Setting& setting, Report& report) {
  const std::uint32_t finest = setting.quick ? 1000 : 20000;
  const Grid grid = grid_round(setting.body(finest), setting.spacing());
  const Tessellation reference = study(format("%u", finest), setting.body(finest), grid, setting.threads);
  Table table{{"triangles", "volume", "apart", "E, normals: median", "p90", "E, infimum: median", "p90",
               "ridge, normals", "ridge, infimum", "curvature skeleton"},
              {}};
  double most = 0;  // median change of E over that of the solid, of tessellations that change it
  const auto add = [&](const Tessellation& one, const Tessellation& base) {
    const double apart = share_apart(one.infimum, base.infimum);
    const std::vector<double> set = changes(ratios(one.set, base.set)),
                              infimum = changes(ratios(one.infimum, base.infimum));
    table.rows.push_back({one.name, format("%+.2f %%", 100 * (one.volume / base.volume - 1)), percent(apart),
                          percent(excess_at(set, 0.5)), percent(excess_at(set, 0.9)),
                          percent(excess_at(infimum, 0.5)), percent(excess_at(infimum, 0.9)),
                          alike(base.set_ridge, one.set_ridge), alike(base.infimum_ridge, one.infimum_ridge),
                          alike(base.curvature, one.curvature)});
    if (apart > 0) most = std::max(most, excess_at(infimum, 0.5) / apart);
    return infimum;
  };
  for (const std::uint32_t triangles : {5000U, 1000U, 500U, 292U}) {
    if (triangles >= finest) continue;
    add(study(format("%u", triangles), setting.body(triangles), grid, setting.threads), reference);
  }
  const core::Mesh& coarse = setting.body(292);
  const std::vector<double> same =
      add(study("292, each in three, against 292", with_triangles_in_three(coarse), grid, setting.threads),
          study("292", coarse, grid, setting.threads));
  report.table(table);
  if (!setting.quick) {  // with a few sample points it is what it may be
    report.expect("E over all directions: its median change over what of the solid lies apart, at most", most,
                  0, 1);
  }
  const auto equal = std::ranges::count_if(same, [](double change) { return change <= 1 + 1e-6; });
  report.expect("triangles in three: share of sample points whose E stays, to 1e-6",
                static_cast<double>(equal) / static_cast<double>(same.size()), 0.999, 1);
}

void compare_sets(const Setting& setting, Report& report) {
  const core::Mesh& body = setting.body(setting.quick ? 292 : 1000);
  const Grid grid = grid_round(body, setting.spacing());
  Fields best(body, grid, setting.quick ? kSeeds : "triangles+sphere:100000", setting.threads);
  best.go_on();
  const Values infimum = best.erosion();
  Table table{{"directions", "median", "p90", "p99", "largest"}, {}};
  const auto add = [&](const std::string& name, const Values& values) {
    const std::vector<double> ratio = ratios(values, infimum);
    table.rows.push_back({name, percent(excess_at(ratio, 0.5)), percent(excess_at(ratio, 0.9)),
                          percent(excess_at(ratio, 0.99)), percent(excess_at(ratio, 1))});
    return ratio;
  };
  std::vector<std::string> sets = {"triangles", "sphere:2000", "sphere:20000"};
  if (!setting.quick) sets.emplace_back("sphere:200000");
  for (const std::string& set : sets)
    add("`" + set + "`", Fields(body, grid, set, setting.threads).erosion());
  Fields few(body, grid, "triangles", setting.threads);
  few.go_on();
  const std::vector<double> ratio = add("infimum from `triangles`", few.erosion());
  report.table(table);
  report.expect("infimum from the normals: excess at 98 of 100 sample points", excess_at(ratio, 0.98), -1,
                0.001);
}

}  // namespace

void tessellation_experiment(const Setting& setting, Report& report) {
  report.section("Tessellations, and the infimum");
  report.text(format(
      "Not published. The body of most triangles beside coarser ones of the same, at the places of one "
      "lattice: by how much its volume differs, how much of it lies in one of the two and not in the "
      "other, by how much E differs over the mesh's normals and over all "
      "directions, and which shares of the skeletons lie within %g of each other, of the coarse one near "
      "the fine one and back: `ridge` over both, and CGAL's mean curvature skeleton (Tagliasacchi and "
      "others 2012, defaults). The last row divides every triangle in three, which moves no surface.",
      kRadius));
  compare_tessellations(setting, report);
  report.subsection("Sets of directions against the infimum");
  report.text("By how much E over a set lies above the infimum, begun from the most directions.");
  compare_sets(setting, report);
}

}  // namespace affskel::experiments
