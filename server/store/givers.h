#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "affskel/v1/client_service.pb.h"
#include "store/rows.h"
#include "wire/field_record.h"

namespace affskel::server {

/// A worker that has told something about a field.
struct Giver {
  std::string worker;  ///< its id
  std::string host;

  friend auto operator<=>(const Giver&, const Giver&) = default;
};

/// The order of work of an erosion, read backwards: which position a direction has.
class DirectionPositions {
 public:
  /// @param stride coprime to `directions`, see wire::direction_at.
  DirectionPositions(std::int64_t directions, std::int64_t stride);

  std::int64_t position(std::uint32_t direction) const;

 private:
  std::uint64_t directions_;
  std::uint64_t inverse_;  // of the stride, modulo directions_
};

/// Keeps that `giver` told about these ranges of positions, and about the directions of the records, whether
/// it calls them done or not.
void note_given(Database& db, const JobRow& job, const Giver& giver, const std::vector<Range>& ranges,
                const std::vector<wire::PointRecord>& records);

/// The workers that told about a job's field, and about how many directions each.  What several told of counts for
/// that whose id comes first in the alphabet, so that together they are no more than the job has.
std::vector<v1::Giver> givers_of(Database& db, const JobRow& job);

/// Positions about which the same workers told.
struct GivenPart {
  std::set<Giver> givers;  ///< empty: done before the server kept the givers
  std::vector<Range> ranges;
};

/// All positions of an erosion of `directions` directions, by the workers that told about them.
std::vector<GivenPart> given_parts(Database& db, std::int64_t erosion_id, std::int64_t directions);

/// What these workers told about, ascending and disjoint.
std::vector<Range> given_by(Database& db, std::int64_t erosion_id, const std::vector<Giver>& givers);

/// Whether one of the ranges, ascending and disjoint, has the position.
bool contains(const std::vector<Range>& ranges, std::int64_t position);

}  // namespace affskel::server
