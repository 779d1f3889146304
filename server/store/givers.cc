#include "store/givers.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <utility>

namespace affskel::server {
namespace {

/// The inverse of `value` modulo `modulus`, to which it is coprime.
std::uint64_t inverse(std::uint64_t value, std::uint64_t modulus) {
  std::int64_t r0 = static_cast<std::int64_t>(modulus), r1 = static_cast<std::int64_t>(value % modulus);
  std::int64_t t0 = 0, t1 = 1;
  while (r1 != 0) {
    const std::int64_t quotient = r0 / r1;
    r0 = std::exchange(r1, r0 - quotient * r1);
    t0 = std::exchange(t1, t0 - quotient * t1);
  }
  const auto signed_modulus = static_cast<std::int64_t>(modulus);
  return static_cast<std::uint64_t>((t0 % signed_modulus + signed_modulus) % signed_modulus);
}

/// Positions in any order, as ascending ranges that do not touch.
std::vector<Range> joined(std::vector<Range> ranges) {
  std::sort(ranges.begin(), ranges.end(), [](Range a, Range b) { return a.begin < b.begin; });
  std::vector<Range> result;
  for (const Range& range : ranges) {
    if (!result.empty() && range.begin <= result.back().end) {
      result.back().end = std::max(result.back().end, range.end);
    } else {
      result.push_back(range);
    }
  }
  return result;
}

/// Ascending, of `count` that there are.  Those of a first report are as many as the points, so that only what is new
/// is kept to be sorted.
std::vector<std::uint32_t> directions_in(const std::vector<wire::PointRecord>& records, std::int64_t count) {
  std::vector<bool> seen(static_cast<std::size_t>(count));
  std::vector<std::uint32_t> directions;
  for (const wire::PointRecord& record : records) {
    if (seen[record.direction]) continue;
    seen[record.direction] = true;
    directions.push_back(record.direction);
  }
  std::sort(directions.begin(), directions.end());
  return directions;
}

void add_given(Database& db, std::int64_t erosion_id, const Giver& giver, Range range) {
  Range whole = range;
  {
    Statement row = db.query(
        "SELECT first_position, end_position FROM given_ranges"
        " WHERE erosion_id = ? AND worker = ? AND first_position <= ? AND end_position >= ?",
        erosion_id, giver.worker, range.end, range.begin);
    while (row.step()) {
      const Range old{row.integer(0), row.integer(1)};
      if (old.begin <= range.begin && old.end >= range.end) return;
      whole = {std::min(whole.begin, old.begin), std::max(whole.end, old.end)};
    }
  }
  db.run(
      "DELETE FROM given_ranges WHERE erosion_id = ? AND worker = ? AND first_position >= ?"
      " AND first_position <= ?",
      erosion_id, giver.worker, whole.begin, whole.end);
  db.run(
      "INSERT INTO given_ranges (erosion_id, worker, host, first_position, end_position)"
      " VALUES (?, ?, ?, ?, ?)",
      erosion_id, giver.worker, giver.host, whole.begin, whole.end);
}

}  // namespace

DirectionPositions::DirectionPositions(std::int64_t directions, std::int64_t stride)
    : directions_(static_cast<std::uint64_t>(directions)),
      inverse_(directions == 1 ? 0 : inverse(static_cast<std::uint64_t>(stride), directions_)) {}

std::int64_t DirectionPositions::position(std::uint32_t direction) const {
  return static_cast<std::int64_t>(direction * inverse_ % directions_);
}

void note_given(Database& db, const JobRow& job, const Giver& giver, const std::vector<Range>& ranges,
                const std::vector<wire::PointRecord>& records) {
  std::vector<Range> all = ranges;
  if (!records.empty()) {
    const DirectionPositions positions(
        job.directions, db.integer("SELECT stride FROM erosions WHERE id = ?", job.erosion_id).value_or(1));
    for (const std::uint32_t direction : directions_in(records, job.directions)) {
      const std::int64_t position = positions.position(direction);
      all.push_back({position, position + 1});
    }
  }
  for (const Range& range : joined(std::move(all))) add_given(db, job.erosion_id, giver, range);
}

std::vector<v1::Giver> givers_of(Database& db, const JobRow& job) {
  std::map<std::string, std::int64_t> directions;
  for (const GivenPart& part : given_parts(db, job.erosion_id, job.directions)) {
    if (part.givers.empty()) continue;
    std::int64_t& count = directions[part.givers.begin()->worker];
    for (const Range& range : part.ranges) count += range.end - range.begin;
  }
  Statement row = db.query(
      "SELECT worker, max(host), sum(points) FROM"
      " (SELECT worker, host, 0 AS points FROM given_ranges WHERE erosion_id = ?1 UNION ALL"
      "  SELECT worker, host, points FROM refined_givers WHERE erosion_id = ?1)"
      " GROUP BY worker ORDER BY worker",
      job.erosion_id);
  std::vector<v1::Giver> givers;
  while (row.step()) {
    Columns columns(row);
    v1::Giver& giver = givers.emplace_back();
    giver.set_worker(columns.text());
    giver.set_host(columns.text());
    giver.set_directions(static_cast<std::uint64_t>(directions[giver.worker()]));
    giver.set_points(columns.natural());
  }
  return givers;
}

std::vector<GivenPart> given_parts(Database& db, std::int64_t erosion_id, std::int64_t directions) {
  // Where a giver's range begins or ends; between two such places the givers are the same.
  std::map<std::int64_t, std::vector<std::pair<Giver, bool>>> changes;
  changes[0];
  changes[directions];
  Statement row = db.query(
      "SELECT worker, host, first_position, end_position FROM given_ranges WHERE erosion_id = ?", erosion_id);
  while (row.step()) {
    const Giver giver{row.text(0), row.text(1)};
    changes[row.integer(2)].emplace_back(giver, true);
    changes[row.integer(3)].emplace_back(giver, false);
  }
  std::map<std::set<Giver>, std::vector<Range>> parts;
  std::set<Giver> present;
  for (auto at = changes.begin(); std::next(at) != changes.end(); ++at) {
    for (const auto& [giver, begins] : at->second) {
      if (!begins) present.erase(giver);
    }
    for (const auto& [giver, begins] : at->second) {
      if (begins) present.insert(giver);
    }
    parts[present].push_back({at->first, std::next(at)->first});
  }
  std::vector<GivenPart> result;
  for (auto& [givers, ranges] : parts) result.push_back({givers, std::move(ranges)});
  return result;
}

std::vector<Range> given_by(Database& db, std::int64_t erosion_id, const std::vector<Giver>& givers) {
  std::vector<Range> ranges;
  for (const Giver& giver : givers) {
    Statement row =
        db.query("SELECT first_position, end_position FROM given_ranges WHERE erosion_id = ? AND worker = ?",
                 erosion_id, giver.worker);
    while (row.step()) ranges.push_back({row.integer(0), row.integer(1)});
  }
  return joined(std::move(ranges));
}

bool contains(const std::vector<Range>& ranges, std::int64_t position) {
  const auto after = std::upper_bound(ranges.begin(), ranges.end(), position,
                                      [](std::int64_t p, const Range& range) { return p < range.begin; });
  return after != ranges.begin() && position < std::prev(after)->end;
}

}  // namespace affskel::server
