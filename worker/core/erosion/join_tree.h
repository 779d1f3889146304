#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/base/none.h"
#include "core/base/vec3.h"
#include "core/erosion/tree_input.h"

namespace affskel::core {

/// V(h) along one arc from one vertex height to the next, scaled units:
///   volume(h) = V + s (A + s (b + s c)),  area(h) = A + s (2 b + 3 s c),  s = h - height.
struct Cubic {
  double height = 0;
  double volume = 0;      ///< V, volume of the component below `height`
  double area = 0;        ///< A, area of its section
  double half_slope = 0;  ///< b = A' / 2
  double sixth_bend = 0;  ///< c = A'' / 6

  double volume_at(double h) const {
    const double s = h - height;
    return volume + s * (area + s * (half_slope + s * sixth_bend));
  }
  double area_at(double h) const {
    const double s = h - height;
    return area + s * (2 * half_slope + 3 * s * sixth_bend);
  }
};

/// An arc of the tree: one component from the height where it is born, or where others merge into it, up to
/// `top`, where it merges into `parent`.  A top is lower than its vertex by HeightOrder::kUnit: at the vertex
/// itself, whichever way its height was rounded, a point lies in the parent.
struct Arc {
  double top = 0;                 ///< +infinity for a root
  double bottom = 0;              ///< height of the first cubic
  std::uint32_t parent = kNone;   ///< kNone for a root
  std::uint32_t first_cubic = 0;  ///< cubics [first_cubic, last_cubic], by height; at least one
  std::uint32_t last_cubic = 0;
  std::uint32_t first_bin = 0;  ///< of the look-up table: equal intervals of height, see JoinTree::bin()
  std::uint32_t last_bin = 0;
  double bin_scale = 0;  ///< number of bins per unit of height
};

/// The sublevel join tree of a solid for one direction d: the components of {y in V : d.y <= t} as t
/// rises, with their exact volumes (see README.md in worker/core).
struct JoinTree {
  std::vector<Arc> arcs;
  std::vector<Cubic> cubics;
  /// Per bin, and one more per arc: the lowest cubic that any height of the bin may need.
  std::vector<std::uint32_t> bins;
  /// Parallel to bins: V at the bottom of the bin or, where volumes may fall (JoinTreeOptions), the least V
  /// from there up to the root.
  std::vector<double> bin_volume;
  std::vector<std::uint32_t> triangle_arc;  ///< per triangle: the arc that its lowest vertex lies on
  std::uint32_t roots = 0;
  double min_volume_change = 0;  ///< of V from one cubic of an arc to the next, scaled units; <= 0

  /// The arc at height h of the component that holds the lowest vertex of `triangle`.
  std::uint32_t climb(std::uint32_t triangle, double h) const {
    std::uint32_t arc = triangle_arc[triangle];
    while (h >= arcs[arc].top) arc = arcs[arc].parent;
    return arc;
  }

  /// The look-up table's bin for height h of the arc.  Grows with h.
  static std::uint32_t bin(const Arc& arc, double h) {
    const double c = (h - arc.bottom) * arc.bin_scale;
    const std::uint32_t last = arc.last_bin - arc.first_bin;
    return arc.first_bin + (c > 0 ? (c < last ? static_cast<std::uint32_t>(c) : last) : 0);
  }

  /// A lower bound of V at h and at all heights above it, up to the root, within twice
  /// TreeInput::volume_tolerance().  Close to V at h unless V falls further up.  One look-up.
  double volume_below(const Arc& arc, double h) const { return bin_volume[bin(arc, h)]; }

  /// The cubic of `arc` that holds height h: the last one that starts at or below h, else the first.
  const Cubic& locate(const Arc& arc, double h) const {
    // It lies between the entries of h's bin and of the next one.
    const std::uint32_t* entry = &bins[bin(arc, h)];
    const Cubic* first = &cubics[entry[0]];
    const Cubic* last = &cubics[entry[1]];
    while (last - first > 8) {
      const Cubic* middle = first + (last - first) / 2;
      (middle->height <= h ? first : last) = middle->height <= h ? middle : middle - 1;
    }
    while (first != last && first[1].height <= h) ++first;
    return *first;
  }
};

struct JoinTreeOptions {
  /// Whether the surface crosses itself.  Regions that it winds round the other way then count as negative
  /// volumes, so that volumes may fall.  Otherwise it is checked that there are as many roots as solids, that
  /// each root's volume at its top is its solid's, and that volumes never fall, both within
  /// TreeInput::volume_tolerance().
  bool crosses_itself = false;
};

/// Builds trees for one direction after another, reusing its memory.  One per thread.
class JoinTreeBuilder {
 public:
  explicit JoinTreeBuilder(const TreeInput& input, const JoinTreeOptions& options = {});
  ~JoinTreeBuilder();

  /// The tree for unit vector d; valid until the next call.  O(N log N).
  /// @throws CoreError kInternal when an invariant fails.
  const JoinTree& build(const Vec3& d);

 private:
  class Work;
  std::unique_ptr<Work> work_;
};

}  // namespace affskel::core
