#include "store/verification.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <unordered_map>
#include <unordered_set>

#include "base/number_text.h"
#include "database/errors.h"
#include "store/field.h"
#include "store/job_events.h"
#include "wire/direction_order.h"
#include "wire/field_record.h"

namespace affskel::server {
namespace {

// A task has at most a sixteenth of all directions, as a block has.
constexpr std::int64_t kParts = 16, kMinPart = 16;

// Task t of sample s.  The number alone may have come to another task since: it is given again.
#define TASK_OF_SAMPLE "t.id = s.task_id AND t.kind = 'verify' AND t.params_key = CAST(s.id AS TEXT)"

/// For each position with stored values, their number.
std::unordered_map<std::int64_t, std::int64_t> values_by_position(Database& db, const JobRow& job,
                                                                  const DirectionPositions& positions) {
  std::unordered_map<std::int64_t, std::int64_t> count;
  FieldView field(db, job.erosion_id, job.points);
  for (std::int64_t index = 0; index < field.chunk_count(); ++index) {
    const std::string chunk = field.chunk(index);
    for (std::size_t at = 0; at < chunk.size(); at += wire::kFieldRecordBytes) {
      const std::uint32_t direction = wire::decode_field_record(chunk.data() + at).direction;
      if (direction != wire::kNoDirection) ++count[positions.position(direction)];
    }
  }
  return count;
}

std::int64_t directions_in(const std::vector<Range>& ranges) {
  std::int64_t count = 0;
  for (const Range& range : ranges) count += range.end - range.begin;
  return count;
}

/// So many of the positions, by chance; each is as likely as every other.
std::vector<std::int64_t> chosen(const std::vector<Range>& ranges, std::int64_t count,
                                 std::mt19937_64& chance) {
  std::vector<std::int64_t> result;
  std::int64_t left = directions_in(ranges);
  for (const Range& range : ranges) {
    for (std::int64_t position = range.begin; position < range.end && count > 0; ++position, --left) {
      if (std::uniform_int_distribution<std::int64_t>(1, left)(chance) > count) continue;
      result.push_back(position);
      --count;
    }
  }
  return result;
}

/// The position with the most stored values; nothing when none has any.
std::optional<std::int64_t> richest(const std::vector<Range>& ranges,
                                    const std::unordered_map<std::int64_t, std::int64_t>& values) {
  std::optional<std::int64_t> best;
  std::int64_t most = 0;
  for (const auto& [position, count] : values) {
    if (!contains(ranges, position) || count < most || (count == most && best && position > *best)) continue;
    best = position;
    most = count;
  }
  return best;
}

std::string positions_message(const std::vector<std::int64_t>& positions) {
  v1::Lease message;  // the field of the lease that they are sent in
  for (const std::int64_t position : positions) {
    const auto begin = static_cast<std::uint64_t>(position);
    const int last = message.positions_size() - 1;
    if (last >= 0 && message.positions(last).end() == begin) {
      message.mutable_positions(last)->set_end(begin + 1);
    } else {
      v1::PositionRange& range = *message.add_positions();
      range.set_begin(begin);
      range.set_end(begin + 1);
    }
  }
  return message.SerializeAsString();
}

std::unordered_set<std::uint32_t> sample_directions(Database& db, const JobRow& job, const TaskRow& task) {
  v1::Lease message;
  message.ParseFromString(task.params);
  const auto stride = static_cast<std::uint64_t>(
      db.integer("SELECT stride FROM erosions WHERE id = ?", job.erosion_id).value_or(1));
  std::unordered_set<std::uint32_t> directions;
  for (const v1::PositionRange& range : message.positions()) {
    for (std::uint64_t position = range.begin(); position < range.end(); ++position) {
      directions.insert(static_cast<std::uint32_t>(
          wire::direction_at(position, stride, static_cast<std::uint64_t>(job.directions))));
    }
  }
  return directions;
}

std::string difference_text(std::int64_t point, const wire::FieldRecord& stored,
                            const wire::FieldRecord& fresh) {
  return "point " + std::to_string(point) + " is stored with E = " + base::to_text(stored.erosion) +
         " of direction " + std::to_string(stored.direction) +
         ", and comes out with E = " + base::to_text(fresh.erosion) +
         (fresh.direction == wire::kNoDirection ? " (no direction of the sample reaches it)"
                                                : " of direction " + std::to_string(fresh.direction));
}

bool less(const wire::FieldRecord& a, const wire::FieldRecord& b) {
  return a.erosion != b.erosion ? a.erosion < b.erosion : a.direction < b.direction;
}

std::string names(const std::vector<Giver>& givers) {
  std::string text;
  for (const Giver& giver : givers) {
    text += (text.empty() ? "" : ", ") + giver.worker;  // hosts are for administrators, events are not
  }
  return text.empty() ? "workers that were not kept" : text;
}

std::vector<Giver> givers_of_sample(Database& db, std::int64_t sample) {
  Statement row =
      db.query("SELECT worker, host FROM sample_givers WHERE sample_id = ? ORDER BY worker", sample);
  std::vector<Giver> givers;
  while (row.step()) givers.push_back({row.text(0), row.text(1)});
  return givers;
}

}  // namespace

std::vector<Sample> choose_samples(Database& db, const JobRow& job, double share) {
  const DirectionPositions positions(
      job.directions, db.integer("SELECT stride FROM erosions WHERE id = ?", job.erosion_id).value_or(1));
  const auto values = values_by_position(db, job, positions);
  std::mt19937_64 chance{std::random_device()()};
  const std::int64_t most = std::max(kMinPart, (job.directions + kParts - 1) / kParts);
  std::vector<Sample> samples;
  for (const GivenPart& part : given_parts(db, job.erosion_id, job.directions)) {
    const std::int64_t all = directions_in(part.ranges);
    const auto count = std::clamp(static_cast<std::int64_t>(std::ceil(share * static_cast<double>(all))),
                                  std::int64_t{1}, all);
    const std::optional<std::int64_t> rich = richest(part.ranges, values);
    std::vector<std::int64_t> taken = chosen(part.ranges, count, chance);
    if (rich && !std::binary_search(taken.begin(), taken.end(), *rich)) {
      taken[std::uniform_int_distribution<std::size_t>(0, taken.size() - 1)(chance)] = *rich;
      std::sort(taken.begin(), taken.end());
    }
    for (auto begin = taken.begin(); begin != taken.end();) {
      const auto end = taken.end() - begin > most ? begin + most : taken.end();
      samples.push_back({part.givers, {begin, end}});
      begin = end;
    }
  }
  return samples;
}

std::int64_t begin_verification(Tx& tx, const JobRow& job, const std::vector<Sample>& samples) {
  // The latest one is enough: what is older was told in the events.
  tx.db.run("DELETE FROM verifications WHERE job_id = ?", job.id);
  tx.db.run("DELETE FROM tasks WHERE job_id = ? AND kind = 'verify'", job.id);
  tx.db.run("INSERT INTO verifications (job_id, created_ms) VALUES (?, ?)", job.id, tx.wall_ms);
  const std::int64_t verification = tx.db.last_insert_rowid();
  for (const Sample& sample : samples) {
    tx.db.run("INSERT INTO samples (verification_id, directions) VALUES (?, ?)", verification,
              sample.positions.size());
    const std::int64_t id = tx.db.last_insert_rowid();
    for (const Giver& giver : sample.givers) {
      tx.db.run("INSERT INTO sample_givers (sample_id, worker, host) VALUES (?, ?, ?)", id, giver.worker,
                giver.host);
    }
    const std::int64_t task = add_sample_task(tx, job.id, positions_message(sample.positions), id);
    tx.db.run("UPDATE samples SET task_id = ? WHERE id = ?", task, id);
  }
  tx.changes.jobs.insert(job.id);
  return verification;
}

std::int64_t verification_under_way(Database& db, const std::string& job) {
  return db
      .integer(
          "SELECT v.id FROM verifications v JOIN samples s ON s.verification_id = v.id JOIN tasks t"
          " ON " TASK_OF_SAMPLE
          " WHERE v.job_id = ? AND s.state = 'pending' AND t.state IN ('pending', 'leased') LIMIT 1",
          job)
      .value_or(0);
}

v1::Verification verification_message(Database& db, const std::string& job, std::int64_t verification) {
  if (!db.integer("SELECT 1 FROM verifications WHERE id = ? AND job_id = ?", verification, job)) {
    throw StoreError(StoreError::Code::kNotFound,
                     "job " + job + " has no verification " + std::to_string(verification) + " (any more)");
  }
  v1::Verification message;
  message.set_id(static_cast<std::uint64_t>(verification));
  message.set_job(job);
  message.set_finished(true);
  Statement row = db.query(
      "SELECT s.id, s.directions, s.state, s.verifier, s.host, s.compared, s.differing, s.message,"
      " ifnull(t.state, '') FROM samples s LEFT JOIN tasks t ON " TASK_OF_SAMPLE
      " WHERE s.verification_id = ? ORDER BY s.id",
      verification);
  while (row.step()) {
    Columns columns(row);
    v1::VerifiedSample& sample = *message.add_samples();
    for (const Giver& giver : givers_of_sample(db, columns.integer())) {
      v1::Giver& to = *sample.add_givers();
      to.set_worker(giver.worker);
      to.set_host(giver.host);
    }
    sample.set_directions(columns.natural());
    const std::string state = columns.text();
    sample.mutable_verifier()->set_worker(columns.text());
    sample.mutable_verifier()->set_host(columns.text());
    sample.set_compared(columns.natural());
    sample.set_differing(columns.natural());
    sample.set_message(columns.text());
    const std::string task = columns.text();
    sample.set_finished(state != "pending" || (task != "pending" && task != "leased"));
    sample.set_failed(sample.finished() && state != "done");
    if (sample.failed() && sample.message().empty()) sample.set_message("cancelled");
    if (!sample.finished()) message.set_finished(false);
  }
  return message;
}

std::optional<std::int64_t> sample_for(Database& db, const Seeker& seeker) {
  return db.integer(
      "SELECT t.id FROM tasks t WHERE t.kind = 'verify' AND t.state = 'pending' AND t.needs_core = ?"
      " AND t.needs_memory <= ? AND NOT EXISTS (SELECT 1 FROM samples s JOIN sample_givers g"
      " ON g.sample_id = s.id WHERE s.id = CAST(t.params_key AS INTEGER) AND g.worker = ?)"
      " ORDER BY t.id LIMIT 1",
      seeker.core_version, seeker.memory, seeker.worker);
}

SampleResult compare_sample(Database& db, const TaskRow& task, std::string_view fresh) {
  const JobRow job = get_job(db, task.job_id);
  if (fresh.size() != static_cast<std::size_t>(job.points) * wire::kFieldRecordBytes) {
    throw StoreError(StoreError::Code::kInvalid, "result: a field of " + std::to_string(fresh.size()) +
                                                     " bytes, not of " + std::to_string(job.points) +
                                                     " points");
  }
  const std::unordered_set<std::uint32_t> sampled = sample_directions(db, job, task);
  FieldView field(db, job.erosion_id, job.points);
  SampleResult result;
  for (std::int64_t index = 0; index < field.chunk_count(); ++index) {
    const std::string chunk = field.chunk(index);
    const std::string_view other =
        fresh.substr(static_cast<std::size_t>(index * kChunkPoints) * wire::kFieldRecordBytes, chunk.size());
    for (std::size_t at = 0; at < chunk.size(); at += wire::kFieldRecordBytes) {
      const wire::FieldRecord stored = wire::decode_field_record(chunk.data() + at);
      const wire::FieldRecord computed = wire::decode_field_record(other.data() + at);
      const bool of_sample = sampled.contains(stored.direction);
      if (of_sample) ++result.compared;
      const bool same = std::string_view(chunk).substr(at, wire::kFieldRecordBytes) ==
                        other.substr(at, wire::kFieldRecordBytes);
      if (of_sample ? same : !less(computed, stored)) continue;
      if (result.differing++ > 0) continue;
      const auto point = index * kChunkPoints + static_cast<std::int64_t>(at / wire::kFieldRecordBytes);
      result.message = difference_text(point, stored, computed);
    }
  }
  return result;
}

void finish_sample(Tx& tx, const TaskRow& task, const SampleResult& result) {
  const std::int64_t sample = std::stoll(task.params_key);
  tx.db.run(
      "UPDATE samples SET state = 'done', verifier = ?, host = ?, compared = ?, differing = ?, message = ?"
      " WHERE id = ?",
      task.worker, task.host, result.compared, result.differing, result.message, sample);
  const std::string of = "directions of " + names(givers_of_sample(tx.db, sample)) + ": ";
  add_event(
      tx, task.job_id,
      result.differing == 0
          ? task_event("verified", task, of + base::counted(result.compared, "value") + " the same")
          : task_event("differs", task,
                       of + base::counted(result.differing, "point") + ", the first: " + result.message));
}

void cancel_samples(Tx& tx, const std::string& job) {
  tx.db.run(
      "UPDATE samples SET state = 'failed', message = 'cancelled' WHERE state = 'pending'"
      " AND verification_id IN (SELECT id FROM verifications WHERE job_id = ?)",
      job);
}

void fail_sample(Tx& tx, const TaskRow& task, const std::string& why) {
  tx.db.run("UPDATE samples SET state = 'failed', message = ? WHERE id = ?", why,
            std::stoll(task.params_key));
}

}  // namespace affskel::server
