#pragma once

#include <cstdint>
#include <vector>

#include "core/mesh/mesh.h"

namespace affskel::core {

/// Takes the points out that no triangle uses; the others keep their order.
/// @return the indices that the points taken out had, ascending.
std::vector<std::uint32_t> drop_unused_points(Mesh& mesh);

/// The mesh with its vertices numbered by their first use, the unused ones left out.
Mesh numbered_by_first_use(const Mesh& mesh);

}  // namespace affskel::core
