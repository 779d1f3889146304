#pragma once

#include <cstdint>

#include "core/mesh/mesh.h"
#include "core/repair/alpha_wrap.h"

namespace affskel::core {

struct SolidWrap {
  Mesh mesh;
  double volume = 0;         ///< of the solid that was wrapped, mesh units cubed; 0: unknown
  bool overlaps = false;     ///< of that what overlaps counts twice: mostly it is less
  std::uint64_t kept = 0;    ///< cavities that the wrap has
  std::uint64_t closed = 0;  ///< cavities that it has not
};

/// The wrap of a mesh from outside and, where it bounds a solid, within each of its cavities: of those in which a ball of
/// alpha has room and whose walls cross no other surface, with the solids in them, and their cavities.  What bounds no
/// solid is wrapped from outside alone.
/// @param options without `from`. @throws CoreError as alpha_wrap.
SolidWrap wrap_solid(const Mesh& mesh, const AlphaWrapOptions& options);

}  // namespace affskel::core
