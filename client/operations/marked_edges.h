#pragma once

#include "client/files/read/mesh_defects.h"
#include "client/view/page.h"

namespace affskel::client {

/// So many defects of a kind are looked for to be marked on a page.
inline constexpr std::size_t kMarkedOnPage = 20'000;

/// The edges of defects, for a page that marks them.
std::vector<MarkedEdge> marked_edges(const core::Mesh& mesh, const std::vector<MeshDefect>& defects);

}  // namespace affskel::client
