#include "store/job_events.h"

#include <optional>
#include <utility>

#include "base/logfmt.h"
#include "base/quoted.h"
#include "wire/words.h"

namespace affskel::server {
namespace {

constexpr std::size_t kMaxMessageBytes = 500;

struct Next {
  std::string owner;
  std::int64_t number = 0;
};

/// Whose job it is, and the number of its next event; nothing when there is no such job.
std::optional<Next> next_of(Database& db, const std::string& job_id) {
  Statement row = db.query(
      "SELECT owner, (SELECT ifnull(max(number), 0) + 1 FROM job_events WHERE job_id = jobs.id)"
      " FROM jobs WHERE id = ?",
      job_id);
  if (!row.step()) return std::nullopt;
  return Next{row.text(0), row.integer(1)};
}

void store(Tx& tx, const std::string& job_id, std::int64_t number, const JobEvent& event) {
  tx.db.run(
      "INSERT INTO job_events (job_id, number, time_ms, event, task, kind, worker, message)"
      " VALUES (?, ?, ?, ?, nullif(?, 0), ?, ?, ?)",
      job_id, number, tx.wall_ms, event.event, event.task, wire::word(event.kind), event.worker,
      base::shortened(event.message, kMaxMessageBytes));
  if (number <= kMaxJobEvents) return;
  tx.db.run(
      "DELETE FROM job_events WHERE job_id = ?1 AND number ="
      " (SELECT min(number) FROM job_events WHERE job_id = ?1 AND number > ?2)",
      job_id, kFirstJobEvents);
}

std::string log_line(const std::string& job_id, const std::string& owner, const JobEvent& event) {
  std::string line = base::logfmt(event.event, {{"job", job_id}});
  if (!owner.empty()) base::append_field(line, {"owner", owner});
  if (event.task != 0) base::append_field(line, {"task", event.task});
  if (event.kind != v1::TASK_KIND_UNSPECIFIED) base::append_field(line, {"kind", wire::word(event.kind)});
  if (!event.worker.empty()) base::append_field(line, {"worker", event.worker});
  if (!event.message.empty()) base::append_field(line, {"message", event.message});
  return line;
}

}  // namespace

JobEvent task_event(std::string_view event, const TaskRow& task, std::string message) {
  return {event, task.id, task.kind, task.worker, std::move(message)};
}

void add_event(Tx& tx, const std::string& job_id, const JobEvent& event) {
  const std::optional<Next> next = next_of(tx.db, job_id);
  if (next) store(tx, job_id, next->number, event);
  tx.changes.log.push_back(log_line(job_id, next ? next->owner : std::string(), event));
}

v1::ListJobEventsResponse job_events(Database& db, const std::string& job_id, std::int64_t after) {
  Statement row = db.query(
      "SELECT number, time_ms, event, ifnull(task, 0), kind, worker, message FROM job_events"
      " WHERE job_id = ? AND number > ? ORDER BY number",
      job_id, after);
  v1::ListJobEventsResponse events;
  events.set_job(job_id);
  while (row.step()) {
    Columns columns(row);
    v1::JobEvent& event = *events.add_events();
    event.set_number(columns.natural());
    event.set_time_ms(columns.natural());
    event.set_event(columns.text());
    event.set_task(columns.natural());
    event.set_kind(columns.text());
    event.set_worker(columns.text());
    event.set_message(columns.text());
  }
  return events;
}

}  // namespace affskel::server
