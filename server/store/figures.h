#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace affskel::server {

/// What of one priority waits.
struct QueueFigures {
  std::int64_t priority = 0;
  std::int64_t jobs = 0;           ///< QUEUED: none of their tasks was leased since
  std::int64_t tasks = 0;          ///< that a worker could be given now, requests for artefacts included
  std::int64_t oldest_age_ms = 0;  ///< since the first of these jobs was queued; 0 without one
};

/// What an owner has.  What several owners use is counted for each of them.
struct OwnerFigures {
  std::string owner;
  std::int64_t jobs = 0;
  std::int64_t active_jobs = 0;  ///< of these QUEUED or RUNNING
  std::int64_t mesh_bytes = 0;
  std::int64_t result_bytes = 0;  ///< fields and artefacts
};

/// What the database takes of the disk, and what is left.
struct DiskFigures {
  std::int64_t database_bytes = 0;          ///< of the file
  std::int64_t log_bytes = 0;               ///< of its write-ahead log
  std::int64_t reserve_bytes = 0;           ///< kept back; 0 while it is given away
  std::optional<std::uint64_t> free_bytes;  ///< where the database lies, if that is known
};

/// What the database holds at a moment.
struct StoreFigures {
  std::vector<QueueFigures> queue;  ///< by priority, all ten
  std::map<std::int64_t, std::int64_t>
      needs;                                 ///< such tasks by the memory that their workers must have, bytes
  std::map<std::string, std::int64_t> jobs;  ///< by state; every state
  std::map<std::string, std::int64_t> leases;  ///< by kind of task
  std::int64_t requests = 0;                   ///< for artefacts that are not there yet
  std::vector<OwnerFigures> owners;            ///< those with most jobs first
  std::int64_t unused_bytes = 0;               ///< of the file, to be given back or used again
  DiskFigures disk;
};

/// Workers that hold leases for jobs of one owner and priority.
struct BusyWith {
  std::int64_t priority = 0;
  std::int64_t rank = 0;  ///< what of it counts across owners
  std::string owner;
  std::int64_t workers = 0;
};

}  // namespace affskel::server
