#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/mesh/box.h"
#include "core/mesh/map_mesh.h"
#include "core/quality/similarity.h"
#include "core/ridge/local_depth.h"
#include "experiments.h"
#include "job.h"
#include "limb_ends.h"
#include "limbed_solids.h"
#include "sheet.h"

namespace affskel::experiments {
namespace {

constexpr double kVoxels = 128;
// Percent.
constexpr double kLeastAxis = 95, kLeastAffine = 99.5, kLeastHalf = 99;
// Where the lattice has so many spacings to the surface, it has four points across.
constexpr double kResolved = 2;

using Places = std::vector<core::Vec3>;

// Percent of one's vertices that the other is near, and of the other's.
struct Shares {
  double there = 100, back = 100;

  std::string text() const { return format("%.1f / %.1f", there, back); }
  double lesser() const { return std::min(there, back); }
};

Shares shares(const Places& one, const Places& other, double radius) {
  const core::Similarity alike = core::similarity(one, other);
  return {100 * alike.a_in_b.share_within(radius), 100 * alike.b_in_a.share_within(radius)};
}

// Of the mapped skeleton and that of the mapped solid.
Shares under_shear(const core::Mesh& mesh, const JobOptions& options, double radius) {
  using namespace core;
  const AffineMap map = then(then(rotation(2, 30), rotation(0, 20)), shear(0, 2, 0.5));
  Places mapped = ridge_sheet_of(compute(mesh, options)).points.place;
  for (Vec3& place : mapped) place = map(place);
  return shares(mapped, ridge_sheet_of(compute(map_mesh(map, mesh), options)).points.place, radius);
}

Places resolved(const Job& job, const Sheet& sheet, double radius) {
  const std::vector<float> deep = core::surface_distance(job.lattice);
  Places places;
  for (std::size_t v = 0; v < sheet.points.size(); ++v)
    if (static_cast<double>(deep[sheet.points.rank[v]]) >= radius) places.push_back(sheet.points.place[v]);
  return places;
}

// Of those of one's vertices that both lattices resolve.
Shares at_half_the_spacing(const core::Mesh& mesh, JobOptions options, double radius) {
  const Job coarse = compute(mesh, options);
  options.spacing /= 2;
  const Job fine = compute(mesh, options);
  const Sheet one = ridge_sheet_of(coarse), other = ridge_sheet_of(fine);
  return {shares(resolved(coarse, one, kResolved), other.points.place, radius).there,
          shares(resolved(fine, other, 2 * kResolved), one.points.place, radius).there};
}

void study(const NamedMesh& solid, const Setting& setting, Table& table, Report& report) {
  const double radius = std::sqrt(3.0) * core::box_of(solid.mesh).longest_side() / kVoxels;
  JobOptions options = comparison_options(solid.mesh, setting);
  const Shares half = at_half_the_spacing(solid.mesh, options, radius);
  const Shares axis = under_shear(solid.mesh, options, radius);
  options.frame = core::FrameKind::kAffine;
  const Shares affine = under_shear(solid.mesh, options, radius);
  table.rows.push_back({solid.name, half.text(), axis.text(), affine.text()});
  const bool body = solid.name.find("body") != std::string::npos;
  if (setting.quick || !body) return;
  report.expect(solid.name + ": lesser share, half the spacing", half.lesser(), kLeastHalf, 100);
  report.expect(solid.name + ": lesser share, sheared, axis", axis.lesser(), kLeastAxis, 100);
  report.expect(solid.name + ": lesser share, sheared, affine", affine.lesser(), kLeastAffine, 100);
}

}  // namespace

void lattice_experiment(const Setting& setting, Report& report) {
  report.section("The ridge on other lattices");
  report.text(
      "Not published: at 100,000 points, in percent, which share of the ridge's vertices is within the diagonal of a voxel of "
      "1/128 of the longest side of the ridge on a lattice of half the spacing, of those that have four points of the coarser "
      "lattice across, and back; and of the mapped ridge near the ridge of the mapped solid, turned by 30 and 20 degrees and "
      "sheared by 1/2, in both frames.  Bodies are held to what is asked of them; the middle of a round limb has a curve, and an "
      "elliptic one, as a sheared tube is, a strip.");
  Table table{{"solid", "half the spacing", "sheared, `axis`", "sheared, `affine`"}, {}};
  std::vector<NamedMesh> solids = solids_to_compare(setting);
  if (setting.meshes.empty()) solids.insert(solids.begin() + 1, {"heavy body of 500", setting.heavy_body()});
  for (const NamedMesh& solid : solids) study(solid, setting, table, report);
  report.table(table);
}

}  // namespace affskel::experiments
