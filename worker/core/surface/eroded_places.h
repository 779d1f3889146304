#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/erosion/frame_field.h"
#include "core/lattice/lattice.h"
#include "core/lattice/lattice_cuts.h"

namespace affskel::core {

/// Which places of a lattice, -1 to dims as in LatticeCuts, belong to an eroded solid, and between which of
/// them the surface of V leaves a gap; two neighbouring layers of constant i at a time, for the whole box
/// would be far larger than the solid in it.  Keeps references to its arguments.
class ErodedPlaces {
 public:
  /// From the first to the last full place of a row; empty when first > last.
  struct Extent {
    std::int64_t first = std::numeric_limits<std::int64_t>::max(), last = -1;

    void take(std::int64_t low, std::int64_t high);
  };

  /// The places (i, j, *).
  struct Row {
    const std::uint8_t* full;  ///< by k: 1 where a sample point has E >= level, else 0
    const std::uint8_t* gaps;  ///< by k: bit `step`, the edge from there by that step has a gap
    Extent extent;             ///< of the full places
  };

  /// @param field, cuts of this lattice.  @param level mesh units cubed.
  ErodedPlaces(const Lattice& lattice, const FrameField& field, const LatticeCuts& cuts, double level);

  /// Makes layers i and i + 1 available; i must grow by one from call to call, from -1 to dims[0] - 1.
  void move_to(std::int64_t i);

  /// @param i of a layer made available.  @param j -1 .. dims[1].
  Row row(std::int64_t i, std::int64_t j) const;

 private:
  struct Layer {
    std::vector<std::uint8_t> full;
    std::vector<std::uint8_t> gaps;
    std::vector<Extent> rows;             // by j + 1
    std::vector<std::size_t> gap_places;  // where gaps are not 0
  };

  static std::size_t slot(std::int64_t i) { return static_cast<std::size_t>(i + 1) % 2; }
  std::size_t in_layer(std::int64_t j, std::int64_t k) const;
  void clear(Layer& filled) const;
  void fill_places(std::int64_t i, Layer& filled);
  void fill_gaps(std::int64_t i, Layer& filled);

  const Lattice& lattice_;
  const FrameField& field_;
  const LatticeCuts& cuts_;
  double level_;
  std::array<std::int64_t, 3> dims_{};
  std::array<Layer, 2> layers_;
  std::size_t next_run_ = 0, next_cut_ = 0;  // of the layer to be filled next
};

}  // namespace affskel::core
