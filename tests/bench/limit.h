#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "mesh_store.h"
#include "result.h"

namespace affskel::bench {

struct LimitOptions {
  std::uint64_t memory = 0;  ///< bytes that a job may use
  std::uint32_t first_triangles = 1000000;
  std::uint64_t first_points = 10000000;
  double longest_s = 15 * 60;  ///< stop doubling after a job that took this long
  std::function<void(const RowResult&)> done = [](const RowResult&) {};  ///< told of every job
};

/// How large a job can be: what was tried, doubling by doubling, the last one being too much.
struct LimitSearch {
  std::string what;                ///< "triangles N" or "points R"
  std::vector<RowResult> results;  ///< in the order tried
  std::string reason;              ///< why the last was the last
};

/// Doubles the triangles of a ball at 1e5 points from first_triangles on, then the points of ball 5120 from
/// first_points on, 20 directions each, until a job fails or takes too long.
std::vector<LimitSearch> find_limits(MeshStore& meshes, const LimitOptions& options);

/// Memory that this machine could give to a new process now, bytes.
std::uint64_t available_memory();

/// Markdown: one table per search, with bytes per triangle or point and the reason of the end.
std::string limits_markdown(const std::vector<LimitSearch>& searches, const LimitOptions& options);

}  // namespace affskel::bench
