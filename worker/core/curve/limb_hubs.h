#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/execution_context.h"
#include "core/base/none.h"
#include "core/base/vec3.h"
#include "core/curve/hub_ellipsoid.h"
#include "core/lattice/lattice.h"

namespace affskel::core {

/// A body that limbs hang on, as an octopus's head, an elephant's torso or a chair's seat: an ellipsoid.
struct LimbHub : HubEllipsoid {
  std::uint32_t joint = 0;  ///< the vertex that stands for it
};

struct LimbHubs {
  std::vector<LimbHub> hubs;
  std::vector<std::uint32_t> of;  ///< per vertex: its hub; kNone of what is a limb's

  const LimbHub* at(std::uint32_t vertex) const { return of[vertex] == kNone ? nullptr : &hubs[of[vertex]]; }
};

struct LimbHubsInput {
  std::span<const Vec3> places;                       ///< per vertex
  std::span<const std::vector<std::uint32_t>> lines;  ///< see polylines(), by numbers in places
  std::span<const double> radius;                     ///< per vertex: see slice_radii()
  std::span<const double> section;                    ///< per vertex: see LimbSection::radius
  const Lattice& lattice;
  std::span<const std::uint32_t> nearest;  ///< per point: a vertex
  ExecutionContext* context = nullptr;     ///< asked whether to stop
};

/// From what no limb has (see parted_lines()), as far as it hangs together in the solid, with a joint, or, where that is nothing,
/// from what lies about the joint, a hub grows: as large as
/// an ellipsoid with its moments, it takes what is nearest to lines in that, too, and so on, until it holds no more, but not
/// along a limb that is longer than it is thick, to its free end; those that both hold the place between their middles are
/// one, if they fill one ellipsoid about as well.  Then one grows from what lies in twice the ellipsoid of that, or of what no
/// limb has, and is the hub, if it is one.
/// It is a hub where a ball as large is 1.4 times as thick as the thickest limb there and 1.55 times as the others, unless it
/// fills less than 0.66 of the ellipsoid (0.74 in the second growth, and beside hubs that it might have joined), and, of one that
/// is the first to grow from its body, what its limbs leave of it less than 0.85 of its own, a network,
/// is 2.25 times as long as wide, a limb, has its middle outside the solid, a ring, or holds the middle of a limb and neither
/// end.  Its limbs begin where they leave the ellipsoid, or within, where their sections are as beyond, or beyond, where
/// these suddenly grow.
LimbHubs limb_hubs(const LimbHubsInput& input);

}  // namespace affskel::core
