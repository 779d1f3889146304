#include "core/shapes/body.h"
#include "experiments.h"

namespace affskel::experiments {

const core::Mesh& Setting::body(std::uint32_t triangles) const {
  const auto [place, made] = bodies_->try_emplace(triangles);
  if (made) place->second = core::make_body({triangles, kBodyHeight});
  return place->second;
}

}  // namespace affskel::experiments
