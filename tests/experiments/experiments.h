#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/mesh/mesh.h"
#include "report.h"

namespace affskel::experiments {

/// How large the experiments are.
class Setting {
 public:
  bool quick = false;  ///< small sizes, for a test that everything works
  unsigned threads = 1;
  /// Of steadiness, noise and graphs: noises of each level; of these, of reach, looks, lattices and limbs: mesh files in the
  /// place of solids of our own.
  unsigned seeds = 2;
  std::vector<std::string> meshes;

  static constexpr double kBodyHeight =
      18000;  ///< gives skeletons of the published order of size at dT = 200
  /// dT: the published 200, coarser when quick.
  double spacing() const { return quick ? 600 : 200; }

  /// A body of our own (core/body.h), made when first asked for and kept.
  const core::Mesh& body(std::uint32_t triangles) const;
  /// That of 500 triangles, wider, deeper and shorter: 1.4 times as heavy, with short limbs.
  core::Mesh heavy_body() const;

 private:
  std::shared_ptr<std::map<std::uint32_t, core::Mesh>> bodies_ =
      std::make_shared<std::map<std::uint32_t, core::Mesh>>();
};

// The sections of Zografos (2003), chapter 6, each appended to the report with pictures, the published
// figures and checks.

/// 6.1: the torus and its dented kin.
void torus_experiment(const Setting& setting, Report& report);
/// 6.1: ellipsoid and sphere.
void ellipsoid_experiment(const Setting& setting, Report& report);
/// 6.1: cylinder and cone.
void revolution_experiment(const Setting& setting, Report& report);
/// 6.2: bodies of growing detail.
void body_experiment(const Setting& setting, Report& report);
/// 6.2.1 and 6.2.2: the skeleton as a surface, and the threshold.
void threshold_experiment(const Setting& setting, Report& report);
/// 6.3: noise.
void noise_experiment(const Setting& setting, Report& report);
/// 6.4: affine maps.
void affine_experiment(const Setting& setting, Report& report);
/// 6.5.1: directions.
void plane_experiment(const Setting& setting, Report& report);
/// Not published: which of a sheet's places are jumps of the normals, and which only fast turns.
void barrier_experiment(const Setting& setting, Report& report);
/// Not published: the ridge under noise, by several seeds.
void steadiness_experiment(const Setting& setting, Report& report);
/// Not published: how near skeletons come to the ends of solids, beside mean curvature skeletons.
void reach_experiment(const Setting& setting, Report& report);
/// Not published: rims, ways, triangles and symmetry of ridges.
void looks_experiment(const Setting& setting, Report& report);
/// Not published: ridges of sheared solids and on finer lattices.
void lattice_experiment(const Setting& setting, Report& report);
/// Not published: one solid in several tessellations, and sets of directions against the infimum.
void tessellation_experiment(const Setting& setting, Report& report);
/// Not published: the infimum at single points against an independent search.
void confirmation_experiment(const Setting& setting, Report& report);
/// Not published: at how many points the infimum is above the least of very many directions.
void miss_experiment(const Setting& setting, Report& report);
/// Not published: the ridge beside medial skeletons, under noise, maps and remeshing.
void medial_experiment(const Setting& setting, Report& report);
/// Not published: the curve skeleton beside mean curvature skeletons.
void limbs_experiment(const Setting& setting, Report& report);
/// Not published: which of its lines stay under noise.
void graph_experiment(const Setting& setting, Report& report);
/// 6.5.2: time against the number of triangles.
void growth_experiment(const Setting& setting, Report& report);

}  // namespace affskel::experiments
