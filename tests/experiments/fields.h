#pragma once

#include <map>
#include <optional>
#include <string>

#include "core/erosion/erosion.h"
#include "core/lattice/lattice.h"
#include "core/lattice/lattice_coordinates.h"
#include "core/mesh/mesh.h"
#include "job.h"

namespace affskel::experiments {

inline constexpr const char* kSeeds = "triangles+sphere:5000";  ///< that infima are begun from

/// A lattice in mesh units, so that solids with other boxes share its places.
struct Grid {
  core::LatticeGrid grid;
  double spacing = 0;
};

Grid grid_round(const core::Mesh& mesh, double spacing);

/// By lattice place.
using Values = std::map<core::LatticePlace, double>;

/// The field of one mesh over a set of directions, and from there over all.
class Fields {
 public:
  Fields(const core::Mesh& mesh, const Grid& grid, const std::string& directions, unsigned threads);

  /// Of the set until go_on() is called, then of all directions: one of its own for each point.
  const Job& job() const { return job_; }

  void go_on();

  /// E, mesh units cubed.
  Values erosion() const;

 private:
  void erode();
  void put(std::uint32_t p, core::FieldValue value);

  unsigned threads_;
  Job job_;
  std::optional<core::Erosion> erosion_;
};

}  // namespace affskel::experiments
