#pragma once

#include <cstdint>
#include <functional>

#include "core/base/vec3.h"
#include "core/infimum/least_chord.h"
#include "core/infimum/near_places.h"
#include "core/infimum/piece_input.h"

namespace affskel::core {

/// Looks for a lesser piece of a sample point x than the one that is known, in basins that a descent does not come to:
/// those between two saddles, which are narrow.  It goes down
///   - from the planes of near places, where these promise less, or not much more;
///   - from the planes that touch two of the saddles known near: those of near places' planes and the nearest ones;
///   - from those that touch one of these and any other, as far as they are near the known plane.
/// Planes whose piece holds a near place of greater E are left out (NearPlaces), unless they are a near place's and
/// promise far less, and so are pairs that may meet no parts at a saddle.
///
/// @param point x's number, of `least`: what is known.
/// @param is_news tells of a point whether the last round changed it: only what that makes new is tried.
/// @param descent with what it holds for x's solid.
/// @return the least piece found; the known one itself where there is no lesser one.
LeastChord look_wider(const PieceInput& input, const Vec3& x, std::uint32_t point, const NearPlaces& near,
                      const std::vector<LeastChord>& least, const std::function<bool(std::uint32_t)>& is_news,
                      ChordDescent& descent);

}  // namespace affskel::core
