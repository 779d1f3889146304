#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "affskel/v1/types.pb.h"
#include "database/sqlite.h"
#include "wire/refined_record.h"

namespace affskel::server {

/// E of a refined point may exceed the set's by so much of it: what a sweep finds has 36 significant bits.
inline constexpr double kMostOfSeed = 1 + 1e-9;

/// What a refined value of a job must keep to.
struct RefinedBounds {
  std::int64_t points = 0;    ///< R
  double volume = 0;          ///< of the solid, mesh units cubed
  std::int64_t vertices = 0;  ///< of its mesh
};

/// Why a refined value cannot be right whatever else is known; "" when it can.
std::string fault_of(const wire::RefinedRecord& record, const RefinedBounds& bounds);

/// Refined values of a report, checked on the way in.
class RefinedBatch {
 public:
  explicit RefinedBatch(const RefinedBounds& bounds) : bounds_(bounds) {}

  /// @throws StoreError kInvalid when arrays do not fit each other, points do not ascend or are out of bounds, or a value
  ///   has a fault.
  void append(const v1::RefinedRecords& records);

  const std::vector<wire::RefinedPointRecord>& records() const { return records_; }

 private:
  RefinedBounds bounds_;
  std::vector<wire::RefinedPointRecord> records_;  // ascending by point
};

/// Stores what a round has found, ascending by point; each point once in a round.
/// @throws StoreError kDamaged when what is stored there does not match its checksum; so below.
void put_refined(Database& db, std::int64_t erosion_id, std::int64_t points, std::int64_t round,
                 const std::vector<wire::RefinedPointRecord>& records);

/// The rows of the log in which the rounds after `known` up to `through` are, oldest first.
std::vector<std::int64_t> refined_log_rows(Database& db, std::int64_t erosion_id, std::int64_t known,
                                           std::int64_t through);

/// The records in one of them, as in a FetchInput of REFINED.
std::string load_refined_log(Database& db, std::int64_t erosion_id, std::int64_t row);

/// Calls `visit` with those of each row.
void visit_refined_log(Database& db, std::int64_t erosion_id, std::int64_t known, std::int64_t through,
                       const std::function<void(std::string_view records)>& visit);

/// The checksum of logged records of a round.
std::int64_t refined_log_sum(std::int64_t erosion_id, std::int64_t round, std::string_view records);

std::int64_t refined_log_bytes(Database& db, std::int64_t erosion_id);

/// Merges into the chunks what is logged of the rounds up to `through`, in their order.
void merge_refined_log(Database& db, std::int64_t erosion_id, std::int64_t points, std::int64_t through);

/// A refined field after a round, in the database's transaction; what is logged is kept in memory.
class RefinedView {
 public:
  RefinedView(Database& db, std::int64_t erosion_id, std::int64_t points, std::int64_t through);

  std::int64_t chunk_count() const;
  /// Bytes of chunk `index`.
  std::string chunk(std::int64_t index) const;

 private:
  Database& db_;
  std::int64_t erosion_id_;
  std::int64_t points_;
  std::vector<wire::RefinedPointRecord> log_;  // the latest of each point, ascending
};

}  // namespace affskel::server
