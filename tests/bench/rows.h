#pragma once

#include <compare>
#include <cstdint>
#include <string>
#include <vector>

namespace affskel::bench {

enum class Shape {
  kTorus,
  kBody,
  kNoisyBody,  ///< with vertex noise of 1 % of the box's diagonal: its surface crosses itself all over
  kBall
};

/// A mesh of the benchmark, by what it is and by how many triangles it has.
struct MeshSpec {
  Shape shape = Shape::kBody;
  std::uint32_t triangles = 0;

  friend auto operator<=>(const MeshSpec&, const MeshSpec&) = default;
};

/// "torus 256", "body 5000", "noisy body 5000", "ball 5120".
std::string mesh_name(const MeshSpec& mesh);

/// The longest side of every body counts as this many units, whatever its file's units are: the size at
/// which the published experiments took their spacing of 200.
inline constexpr double kBodyUnits = 18000;

/// What a row is measured for.
enum class Section {
  kTable,    ///< the speed table
  kGrowthN,  ///< growth of the wall time over N at fixed R and K
  kGrowthR,  ///< growth of the wall time over R at fixed N and K
  kMemory,   ///< peak memory alone
};

/// One row: a job to time, in a process of its own.
struct RowSpec {
  Section section = Section::kTable;
  MeshSpec mesh;
  std::uint64_t points = 0;              ///< sample points aimed at, or 0 with a spacing
  double spacing = 0;                    ///< in units (see kBodyUnits), or 0 with points
  std::string directions = "triangles";  ///< direction set, as make_directions() takes it
  std::uint64_t max_directions = 0;      ///< work on a stretch of at most so many; 0: on all
};

/// A row's name, unique within a set: "body 5000, 1e5 points", "body 292, dT 200".
std::string row_name(const RowSpec& row);

enum class RowSet {
  kQuick,    ///< under a minute; what the continuous check measures
  kDefault,  ///< under a quarter of an hour on two cores
  kFull      ///< also all directions of the largest body, and the large ball
};

/// The rows of a set in the order they are measured and printed.
std::vector<RowSpec> rows_of(RowSet set);

}  // namespace affskel::bench
