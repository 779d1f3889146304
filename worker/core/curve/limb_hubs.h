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

/// A hub is what lies in its own ellipsoid, that with its moments (see HubEllipsoid::of()), by the middle of what is nearest
/// to each vertex.  From every body of what no limb has (see parted_lines()), as far as it touches, with what lies within half
/// the radius of its joints, and from twice its ellipsoid, this is taken anew until it stays: once all, and once without the
/// outer half of limbs that end free and are longer than it is thick, as a palm would take its forearm; if that has the
/// whole of a limb that is longer than half its thickness, as a palm of a short wrist, once more without that of limbs as
/// long.  Its limbs begin where they leave the ellipsoid, or within, where their sections are as beyond, or as they taper
/// there, or beyond, where these suddenly grow.
///
/// It is a hub if what they leave
/// - is 1.4 times as thick, as a ball, as the thickest limb and 1.55 times as the others,
/// - is less than 1.2 times what lay in the ellipsoid,
/// - fills more than two thirds of an ellipsoid, no network, is not 2.25 times as long as wide, a limb, has its middle in the
///   solid, no ring, and is three spacings thick,
/// - and there is in it a joint, and neither the free end of a limb that is longer than it is thick, nor two thirds unless it
///   is 2.5 times as thick, nor the middle of one and neither end.
/// Of those in one place, where the middle of one lies in the other, it is the one that has most, less twice what its
/// ellipsoid lacks; if it has a limb whole that is longer than half its thickness this counts a tenth.
LimbHubs limb_hubs(const LimbHubsInput& input);

}  // namespace affskel::core
