#pragma once

#include "report.h"

namespace affskel::experiments {

/// How large the experiments are.
struct Setting {
  bool quick = false;  ///< small sizes, for a test that everything works
  unsigned threads = 1;

  double body_height = 18000;  ///< the published bodies are about as tall, in their units
  /// dT: the published 200, coarser when quick.
  double spacing() const { return quick ? 600 : 200; }
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
/// 6.5.2: time against the number of triangles.
void growth_experiment(const Setting& setting, Report& report);

}  // namespace affskel::experiments
