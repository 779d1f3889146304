#pragma once

#include "core/curve/sliced_lines.h"
#include "core/curve/tubed_limbs.h"

namespace affskel::core {

/// Parts a solid where its limbs meet, by their tubes (see tubed_limbs()). What lies there in the tube of a limb that
/// is thicker, all in all, belongs to that, of several about as thick to the one that it lies deepest in; what lies
/// in its own tube to that; else it belongs to the limb whose tube it lies deepest in, or is nearest to, to one that is
/// no thicker near a joint alone: not to a hand at a hip.  So an arm begins where it leaves the trunk, from the armpit to
/// the top of the shoulder, equal limbs share their joint evenly, and a joint itself has nothing, unless it is a hub (see
/// limb_hubs()): then it is the thickest, and its tube is an ellipsoid, but for what a limb that begins in there has
/// round its line.  A link or loop whose line lies in the tubes of the others that it meets, whole, has nothing either.
/// @return refers to the input's places.
VertexOfPlace limb_tubes(const TubedLimbsInput& input);

}  // namespace affskel::core
