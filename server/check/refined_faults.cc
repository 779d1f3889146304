#include "check/refined_faults.h"

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "database/checksum.h"
#include "store/field.h"
#include "store/refinement.h"
#include "store/rows.h"
#include "wire/field_record.h"

namespace affskel::server {
namespace {

/// Of one refinement.
class RefinedCheck {
 public:
  RefinedCheck(Database& db, const FieldShape& field, const std::function<void(FieldFault)>& on_fault)
      : db_(db),
        field_(field),
        on_fault_(on_fault),
        name_("erosion " + std::to_string(field.erosion_id)),
        bounds_(refined_bounds(db, field.erosion_id)),
        round_(db.integer("SELECT round FROM erosions WHERE id = ?", field.erosion_id)),
        done_(done_ranges(db, field.erosion_id, Done::kPoints)) {}

  void run() {
    check_chunks();
    check_log();
  }

 private:
  void fault(const std::string& where, const std::string& what) {
    on_fault_({nullptr, 0, name_ + where, what});
  }

  bool is_done(std::int64_t point) const {
    if (*round_ > 0) return true;
    for (const Range& range : done_) {
      if (range.begin <= point && point < range.end) return true;
    }
    return false;
  }

  void check_chunks() {
    const std::int64_t count = field_chunk_count(field_.points);
    std::vector<bool> found(static_cast<std::size_t>(count), false);
    Statement row =
        db_.query("SELECT idx, data, sum FROM refined_chunks WHERE erosion_id = ?", field_.erosion_id);
    while (row.step()) {
      const std::int64_t index = row.integer(0);
      const std::string where = ", refined chunk " + std::to_string(index);
      if (!round_ || index >= count) {
        fault(where, "belongs to no refinement");
        continue;
      }
      found[static_cast<std::size_t>(index)] = true;
      const std::string what = fault_of_chunk(index, row.blob(1), row.integer(2));
      if (!what.empty()) fault(where, what);
    }
    for (std::int64_t index = 0; round_ && index < count; ++index) {
      const std::int64_t end = std::min(field_.points, (index + 1) * kChunkPoints);
      if (!found[static_cast<std::size_t>(index)] && any_done(index * kChunkPoints, end))
        fault(", refined chunk " + std::to_string(index), "is missing");
    }
  }

  bool any_done(std::int64_t begin, std::int64_t end) const {
    for (std::int64_t point = begin; point < end; ++point)
      if (is_done(point)) return true;
    return false;
  }

  std::string fault_of_chunk(std::int64_t index, std::string_view bytes, std::int64_t sum) const {
    if (bytes.size() != field_chunk_points(field_.points, index) * wire::kRefinedRecordBytes)
      return "has " + std::to_string(bytes.size()) + " bytes, not those of its points";
    if (sum != checksum(field_.erosion_id, index, bytes)) return "does not match its checksum";
    const std::string seeds = seeds_of(index);
    for (std::size_t i = 0; i * wire::kRefinedRecordBytes < bytes.size(); ++i) {
      const auto point = index * kChunkPoints + static_cast<std::int64_t>(i);
      if (!is_done(point)) continue;
      const wire::RefinedRecord record =
          wire::decode_refined_record(bytes.data() + i * wire::kRefinedRecordBytes);
      const std::string what = fault_of_value(record, seeds, i);
      if (!what.empty()) return "point " + std::to_string(point) + ": " + what;
    }
    return {};
  }

  std::string fault_of_value(const wire::RefinedRecord& record, std::string_view seeds,
                             std::size_t at) const {
    if (record.round > *round_) return "is of round " + std::to_string(record.round);
    if (std::string what = fault_of(record, bounds_); !what.empty()) return what;
    if (seeds.empty()) return {};  // the field's own check tells of that
    const double seed = wire::decode_field_record(seeds.data() + at * wire::kFieldRecordBytes).erosion;
    return record.erosion <= seed * kMostOfSeed ? std::string() : "E is above that of the set of directions";
  }

  /// The set's chunk, empty when it has faults of its own.
  std::string seeds_of(std::int64_t index) const {
    Statement row =
        db_.query("SELECT data FROM field_chunks WHERE erosion_id = ? AND idx = ?", field_.erosion_id, index);
    const bool whole = row.step() && row.blob(0).size() ==
                                         field_chunk_points(field_.points, index) * wire::kFieldRecordBytes;
    return whole ? std::string(row.blob(0)) : std::string();
  }

  void check_log() {
    Statement row =
        db_.query("SELECT data, sum, id, round FROM refined_log WHERE erosion_id = ?", field_.erosion_id);
    while (row.step()) {
      const std::string what = fault_of_log(row.blob(0), row.integer(1), row.integer(3));
      if (!what.empty()) fault(", logged report " + row.text(2) + " of the refinement", what);
    }
  }

  std::string fault_of_log(std::string_view bytes, std::int64_t sum, std::int64_t round) const {
    if (!round_ || round > *round_ || field_.finished) return "belongs to no round";
    if (sum != refined_log_sum(field_.erosion_id, round, bytes)) return "does not match its checksum";
    for (; bytes.size() >= wire::kRefinedPointRecordBytes;
         bytes.remove_prefix(wire::kRefinedPointRecordBytes)) {
      const wire::RefinedPointRecord named = wire::decode_refined_point_record(bytes.data());
      const std::string point = "point " + std::to_string(named.point);
      if (named.point >= field_.points) return point + " of " + std::to_string(field_.points);
      if (std::string what = fault_of(named.record, bounds_); !what.empty()) return point + ": " + what;
    }
    return {};
  }

  Database& db_;
  const FieldShape& field_;
  const std::function<void(FieldFault)>& on_fault_;
  const std::string name_;
  const RefinedBounds bounds_;
  const std::optional<std::int64_t> round_;
  const std::vector<Range> done_;
};

}  // namespace

void find_refined_faults(Database& db, const FieldShape& field,
                         const std::function<void(FieldFault)>& on_fault) {
  RefinedCheck(db, field, on_fault).run();
}

}  // namespace affskel::server
