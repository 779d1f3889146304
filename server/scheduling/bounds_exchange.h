#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "affskel/v1/worker_service.pb.h"
#include "base/mutex.h"
#include "store/field.h"

namespace affskel::server {

struct BoundsExchangeOptions {
  std::size_t kept_bytes = std::size_t{64} << 20;     ///< of all fields; what is oldest is forgotten
  std::size_t message_points = std::size_t{1} << 16;  ///< per v1::ErosionBounds
  std::size_t fields = 256;                           ///< whose workers are remembered
  std::size_t workers = 1024;                         ///< that are remembered of one field
};

/// What the workers on one field learn from each other's reports: without it each leaves out only what its own
/// directions rule out, and reports improvements that others have outdone.  Kept in memory and lost without
/// harm, for bounds only save time.  Thread-safe.
///
/// A field is named as in v1::Lease: when something was taken out of it, it has another name, so that nobody hears
/// bounds that do not hold any more.
class BoundsExchange {
 public:
  explicit BoundsExchange(const BoundsExchangeOptions& options = {}) : options_(options) {}

  /// A worker begins on a field: it has company from now on, and is kept what the others report.
  void join(const std::string& field, const std::string& worker);

  /// Passes on a report that is committed, and adds to the answer what other workers on it reported
  /// since this worker's last one, or since it joined them; one that has not does so with its first.
  /// @param records of the report; passed on when in ascending order of points, as our workers send them.
  /// @param room bytes of bounds that the answer may hold on the wire; the rest comes with the next.
  void exchange(const std::string& field, const std::string& worker,
                const std::vector<wire::PointRecord>& records, std::size_t room,
                v1::ReportResponse& response);

  /// Passes on a part of a report, committed before the rest of it has come.
  void pass_on(const std::string& field, const std::string& worker,
               const std::vector<wire::PointRecord>& records);

  /// The field is finished: its bounds are not needed any more.
  void forget(const std::string& field);

  /// Reports that are kept for workers that have not heard of them, of all fields.
  std::size_t kept() const;

 private:
  using Message = std::shared_ptr<const v1::ErosionBounds>;
  struct Entry {
    std::string field, worker;
    Message message;         // null: forgotten
    std::size_t bytes;       // in memory
    std::size_t wire_bytes;  // serialized
  };

  std::vector<Message> pack(const std::vector<wire::PointRecord>& records) const;
  bool enter(const std::string& field, const std::string& worker) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  std::vector<Message> collect(const std::string& field, const std::string& worker, std::size_t room)
      ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void keep(const std::string& field, const std::string& worker, const std::vector<Message>& messages)
      ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void drop_first() ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void close_ranks() ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);

  const BoundsExchangeOptions options_;
  mutable base::Mutex mutex_;
  std::deque<Entry> entries_ ABSL_GUARDED_BY(mutex_);    // entry number n is at n - forgotten_
  std::uint64_t forgotten_ ABSL_GUARDED_BY(mutex_) = 0;  // entries so far
  std::size_t bytes_ ABSL_GUARDED_BY(mutex_) = 0;
  std::size_t dead_ ABSL_GUARDED_BY(mutex_) = 0;  // entries without a message
  std::map<std::string, std::map<std::string, std::uint64_t>> seen_
      ABSL_GUARDED_BY(mutex_);  // field, worker: its first unseen entry
};

}  // namespace affskel::server
