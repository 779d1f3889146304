#pragma once

#include <cstdint>
#include <list>
#include <memory>
#include <string>

#include "job/prepared_job.h"

namespace affskel::worker {

/// A job made ready, with the field as far as the server has acknowledged it.
struct ShelvedJob {
  std::string id;
  std::string field;  ///< which one it is, see Lease.field
  std::unique_ptr<PreparedJob> job;
};

/// Bytes that a prepared job takes, roughly: by its triangles and points.
std::uint64_t bytes_of(const PreparedJob& job);

/// The jobs that a worker has left for others' turns.  It will come back to them, and each would have to be
/// fetched and made ready anew.
class JobShelf {
 public:
  /// @param budget bytes that the jobs may take together; those left longest ago go first.
  explicit JobShelf(std::uint64_t budget) : budget_(budget) {}

  void put(ShelvedJob job);
  /// The job when it is there, otherwise null; without a field when it was left with another one.
  std::unique_ptr<PreparedJob> take(const std::string& id, const std::string& field);
  void clear() { jobs_.clear(); }
  /// That the jobs take.
  std::uint64_t bytes() const;

 private:
  const std::uint64_t budget_;
  std::list<ShelvedJob> jobs_;  // the last that was left comes first
};

}  // namespace affskel::worker
