#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "affskel/v1/client_service.pb.h"
#include "store/task_rows.h"
#include "store/tx.h"

namespace affskel::server {

/// Something that happened to a job.
struct JobEvent {
  std::string_view event;                         ///< a word for programs: "leased"
  std::int64_t task = 0;                          ///< 0 = about the job as a whole
  v1::TaskKind kind = v1::TASK_KIND_UNSPECIFIED;  ///< of the task
  std::string worker = {};                        ///< its id, if one took part
  std::string message = {};                       ///< for people; what is longer than 500 bytes is cut off
};

/// About a task and the worker that has it.
JobEvent task_event(std::string_view event, const TaskRow& task, std::string message = {});

// Of more events than these, the first of the job and the latest are kept; what lies between is left out.
inline constexpr std::int64_t kMaxJobEvents = 200;
inline constexpr std::int64_t kFirstJobEvents = 50;

/// Adds to the events of a job, in the transaction that it tells of, and once that is committed to the
/// server's log.  Of a job that is not there, only to the log.
void add_event(Tx& tx, const std::string& job_id, const JobEvent& event);

/// The events of a job that are kept, oldest first, with a number greater than `after`.
v1::ListJobEventsResponse job_events(Database& db, const std::string& job_id, std::int64_t after);

}  // namespace affskel::server
