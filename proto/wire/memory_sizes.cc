#include "wire/memory_sizes.h"

#include "wire/params.h"

namespace affskel::wire {

std::uint64_t skeleton_bytes_per_point(v1::Operator which) {
  if (which == v1::OPERATOR_CHORDS) return 400;
  return gives_sheet(which) ? 200 : 0;
}

}  // namespace affskel::wire
