#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "rows.h"

namespace affskel::bench {

/// Time of the published program's method on a row's mesh, spacing and step.
struct ReferenceTime {
  double seconds = 0;                 ///< for all triangles
  std::uint64_t triangles_timed = 0;  ///< the sample that was timed and scaled from
};

/// What was measured for one row.  Times are wall-clock seconds of the fastest run, on one thread
/// unless the name says otherwise.
struct RowResult {
  std::string name;
  std::string source;  ///< of the mesh: "generated" or a file's name
  Section section = Section::kTable;
  std::string error;  ///< why there are no figures; empty when there are

  std::uint64_t triangles = 0;       ///< N
  std::uint64_t points = 0;          ///< R
  std::uint64_t directions = 0;      ///< K, those worked on
  std::uint64_t directions_all = 0;  ///< those of the whole set
  double spacing = 0;                ///< dT, the mesh's units
  double v0 = 0;                     ///< volume, the mesh's units cubed

  double prepare_s = 0, trees_s = 0, sweep_s = 0, wall_s = 0;
  double trees_cpu_s = 0;  ///< processor time, of every stretch of directions that of its fastest run
  double sweep_cpu_s = 0;  ///< the same
  int repeats = 0;         ///< runs, of which the best is reported
  double peak_mb = 0;      ///< ru_maxrss of the row's own process after its first run, 2^20 bytes
  std::uint64_t chords_evaluated = 0, chords_tested = 0;

  std::optional<double> sort_unit_s;  ///< processor time of one sort of N/2 pairs
  std::optional<double> plain_ns;     ///< processor time of the plain sweep per (point, direction)
  std::uint64_t sort_directions = 0, plain_directions = 0;  ///< the yardsticks' samples

  std::optional<double> wall_two_threads_s;
  std::optional<ReferenceTime> reference;

  double pairs() const { return static_cast<double>(points) * static_cast<double>(directions); }
  /// Effective cost of the sweep per (point, direction), wall.
  double sweep_ns() const { return 1e9 * sweep_s / pairs(); }
  /// Point-directions per second of the whole job, R K / wall.
  double rate() const { return pairs() / wall_s; }
  double tree_ns_per_triangle() const {
    return 1e9 * trees_s / (static_cast<double>(directions) * static_cast<double>(triangles));
  }
  /// Processor time of all trees over K sort units.
  std::optional<double> trees_per_sort() const;
  /// Processor time of the plain sweep over that of the pruned one.
  std::optional<double> plain_per_pruned() const;
  std::optional<double> two_thread_speed_up() const;
  std::optional<double> reference_per_wall() const;
  /// What the project allows itself: 64 bytes per point, 500 per triangle, 60 MB.
  double memory_allowed_mb() const;
};

/// All fields and the derived figures above.
void to_json(nlohmann::json& json, const RowResult& result);
/// @throws nlohmann::json::exception when it is not what to_json() wrote.
void from_json(const nlohmann::json& json, RowResult& result);

}  // namespace affskel::bench
