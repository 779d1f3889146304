#include "core/mesh/map_mesh.h"
#include "core/shapes/body.h"
#include "experiments.h"

namespace affskel::experiments {

const core::Mesh& Setting::body(std::uint32_t triangles) const {
  const auto [place, made] = bodies_->try_emplace(triangles);
  if (made) place->second = core::make_body({triangles, kBodyHeight});
  return place->second;
}

core::Mesh Setting::heavy_body() const {
  return core::map_mesh(core::scaling(1.25, 1.5, 0.75), body(500));
}

}  // namespace affskel::experiments
