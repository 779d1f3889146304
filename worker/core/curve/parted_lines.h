#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/disjoint_sets.h"
#include "core/base/matrix3.h"
#include "core/base/vec3.h"

namespace affskel::core {

/// Of places, each as much.
struct PlaceMoments {
  double count = 0;
  Vec3 first;
  Matrix3 second{};

  void add(const PlaceMoments& other) {
    count += other.count;
    first = first + other.first;
    second = second + other.second;
  }
  Vec3 centre() const { return (1 / count) * first; }
  Matrix3 about_centre() const { return second + -1.0 * outer(first, centre()); }
};

/// The mean square of a place in a cell of a lattice of cubes, along an axis through its middle.
inline double square_in_cell(double spacing) {
  return spacing * spacing / 12;
}

/// Lengths in one unit.
struct PartedLinesInput {
  std::span<const Vec3> places;                       ///< per vertex
  std::span<const std::vector<std::uint32_t>> lines;  ///< see polylines(), by numbers in places
  std::span<const double> radius;                     ///< per vertex: see slice_radii()
  std::span<const PlaceMoments> moments;              ///< per vertex: of the points that are nearest to it
  double spacing = 0;                                 ///< of these
};

struct PartedLimb {
  std::vector<std::uint32_t> line;  ///< whole
  double size = 0;                  ///< how thick it is: the middle one of the radii
  double length = 0;
};

/// What of lines is a limb's, and what a body's.
struct PartedLines {
  std::vector<PartedLimb> limbs;
  std::vector<std::uint32_t> limb;  ///< per vertex: that its line is; kNone of a joint, and where it is none
  std::vector<char> is_body;        ///< per vertex
  DisjointSets bodies;              ///< of vertices, along lines
};

/// Of what is nearest to a line, a limb has what makes about a tube.  From its middle on towards a joint it ends where that
/// suddenly grows.  A link or loop that is shorter than thick is no limb, nor a link most of whose slices are twice as wide as
/// thick.
PartedLines parted_lines(const PartedLinesInput& input);

/// Whether a size suddenly grows towards the front of a line, at its n-th vertex, over as much as it is beyond.
/// @param size per vertex.
bool grows_at(std::span<const Vec3> places, std::span<const std::uint32_t> line, std::size_t n,
              std::span<const double> size);

}  // namespace affskel::core
