#include "store/turn.h"

#include <tuple>

namespace affskel::server {
namespace {

/// What tasks need of a worker: each pair has its own part of the indexes queues_in_order and tasks_ready.
struct Need {
  std::string core_version;  // "" = any
  std::int64_t memory = 0;
};

/// An owner with ready tasks, among all owners.
struct OwnersTurn {
  std::string owner;
  std::int64_t rank = 0;      ///< what of the priority counts across owners
  std::int64_t priority = 0;  ///< among the owner's own
  std::int64_t turn = 0;

  static OwnersTurn of(const Statement& row) {
    return {row.text(0), row.integer(1), row.integer(2), row.integer(3)};
  }
  bool before(const OwnersTurn& other) const {
    return std::tie(other.rank, turn, owner, other.priority) <
           std::tie(rank, other.turn, other.owner, priority);
  }
};

/// A ready task, among those of its owner and priority.
struct Candidate {
  std::int64_t id = 0;
  std::int64_t turn = 0;
  std::int64_t seq = 0;
  std::string job;
  std::string owner;

  static Candidate of(const Statement& row) {
    return {row.integer(0), row.integer(1), row.integer(2), row.text(3), row.text(4)};
  }
  bool before(const Candidate& other) const {
    return std::tie(turn, seq, id) < std::tie(other.turn, other.seq, other.id);
  }
};

/// Calls visit(need) for every need that ready tasks have and the worker meets.
template <typename Visit>
void for_each_need(Database& db, const Seeker& seeker, bool on_request, Visit&& visit) {
  for (const std::string& core : {std::string(), seeker.core_version}) {
    std::optional<std::int64_t> memory = -1;
    for (;;) {
      memory = db.integer(
          "SELECT needs_memory FROM queues WHERE on_request = ? AND needs_core = ? AND needs_memory > ?"
          " AND needs_memory <= ? ORDER BY needs_memory LIMIT 1",
          on_request, core, *memory, seeker.memory);
      if (!memory) break;
      visit(Need{core, *memory});
    }
  }
}

/// The first of what queries tell, one for each need.
/// @param query its first row; of the need.
template <typename Found, typename Query>
std::optional<Found> first_of_needs(Database& db, const Seeker& seeker, bool on_request, const Query& query) {
  std::optional<Found> first;
  for_each_need(db, seeker, on_request, [&](const Need& need) {
    Statement row = query(need);
    if (!row.step()) return;
    Found found = Found::of(row);
    if (!first || found.before(*first)) first = std::move(found);
  });
  return first;
}

std::optional<OwnersTurn> owner_in_turn(Database& db, const Seeker& seeker, bool on_request) {
  return first_of_needs<OwnersTurn>(db, seeker, on_request, [&](const Need& need) {
    return db.query(
        "SELECT owner, rank, priority, turn FROM queues WHERE on_request = ? AND needs_core = ?"
        " AND needs_memory = ? ORDER BY rank DESC, turn, owner, priority DESC LIMIT 1",
        on_request, need.core_version, need.memory);
  });
}

/// The owner's highest priority among ready tasks of jobs, and its rank.
std::optional<OwnersTurn> turn_of_owner(Database& db, const Seeker& seeker, const std::string& owner) {
  return first_of_needs<OwnersTurn>(db, seeker, false, [&](const Need& need) {
    return db.query(
        "SELECT owner, rank, priority, turn FROM queues WHERE owner = ? AND on_request = 0 AND needs_core = ?"
        " AND needs_memory = ? ORDER BY priority DESC LIMIT 1",
        owner, need.core_version, need.memory);
  });
}

std::optional<Candidate> first_of_owner(Database& db, const Seeker& seeker, bool on_request,
                                        const std::string& owner, std::int64_t priority) {
  return first_of_needs<Candidate>(db, seeker, on_request, [&](const Need& need) {
    return db.query(
        "SELECT id, turn, seq, job_id, owner FROM tasks WHERE state = 'pending' AND parked = 0"
        " AND on_request = ? AND needs_core = ? AND needs_memory = ? AND priority = ? AND owner = ?"
        " ORDER BY turn, seq, id LIMIT 1",
        on_request, need.core_version, need.memory, priority, owner);
  });
}

/// A task of the job that the worker holds, if that is of its owner's highest priority, and this counts as
/// much as that of the owner whose turn it is.
std::optional<Candidate> of_held_job(Database& db, const Seeker& seeker, const OwnersTurn& turn) {
  if (seeker.preferred_job.empty()) return std::nullopt;
  Statement row = db.query(
      "SELECT id, turn, seq, job_id, owner, priority FROM tasks WHERE job_id = ? AND state = 'pending'"
      " AND parked = 0 AND on_request = 0 AND needs_core IN ('', ?) AND needs_memory <= ? ORDER BY id"
      " LIMIT 1",
      seeker.preferred_job, seeker.core_version, seeker.memory);
  if (!row.step()) return std::nullopt;
  Candidate held = Candidate::of(row);
  const std::int64_t priority = row.integer(5);
  const std::optional<OwnersTurn> own =
      held.owner == turn.owner ? turn : turn_of_owner(db, seeker, held.owner);
  if (!own || own->rank != turn.rank || own->priority != priority) return std::nullopt;
  return held;
}

/// Workers beside this one that work on an owner's jobs.
std::int64_t others_on_owner(Database& db, const Seeker& seeker, const std::string& owner) {
  return db
      .integer(
          "SELECT count(DISTINCT worker) FROM tasks WHERE state = 'leased' AND on_request = 0 AND owner = ?"
          " AND worker <> ?",
          owner, seeker.worker)
      .value_or(0);
}

std::int64_t others_on_job(Database& db, const Seeker& seeker, const std::string& job) {
  return db
      .integer(
          "SELECT count(DISTINCT worker) FROM tasks WHERE job_id = ? AND state = 'leased' AND on_request = 0"
          " AND worker <> ?",
          job, seeker.worker)
      .value_or(0);
}

/// Whether going on with the job that it holds leaves no owner worse off.
bool may_keep(Database& db, const Seeker& seeker, const Candidate& held, const Candidate& next,
              OwnerOrder order) {
  std::optional<Candidate> owners_next = next;
  if (held.owner != next.owner) {
    if (others_on_owner(db, seeker, held.owner) >= others_on_owner(db, seeker, next.owner)) return false;
    const std::optional<OwnersTurn> own = turn_of_owner(db, seeker, held.owner);
    owners_next = own ? first_of_owner(db, seeker, false, held.owner, own->priority) : std::nullopt;
  }
  if (order == OwnerOrder::kFirstCome || !owners_next || owners_next->job == held.job) return true;
  return others_on_job(db, seeker, held.job) < others_on_job(db, seeker, owners_next->job);
}

}  // namespace

std::optional<std::int64_t> task_in_turn(Database& db, const Seeker& seeker, bool on_request,
                                         OwnerOrder order) {
  const std::optional<OwnersTurn> turn = owner_in_turn(db, seeker, on_request);
  if (!turn) return std::nullopt;
  const std::optional<Candidate> next = first_of_owner(db, seeker, on_request, turn->owner, turn->priority);
  if (!next) return std::nullopt;
  if (on_request) return next->id;
  const std::optional<Candidate> held = of_held_job(db, seeker, *turn);
  return held && may_keep(db, seeker, *held, *next, order) ? held->id : next->id;
}

void end_turn(Tx& tx, const TaskRow& task) {
  const std::int64_t turn = tx.db.integer("SELECT max(0, ifnull(max(turn), 0)) + 1 FROM turns").value_or(1);
  tx.db.run(
      "UPDATE turns SET turn = ?1 WHERE on_request = ?3 AND owner = (SELECT owner FROM tasks WHERE id = ?2)",
      turn, task.id, task.on_request);
  tx.db.run(
      "UPDATE queues SET turn = ?1 WHERE on_request = ?3 AND owner = (SELECT owner FROM tasks WHERE id = ?2)",
      turn, task.id, task.on_request);
  if (tx.options.owner_order == OwnerOrder::kFirstCome || task.on_request) return;
  tx.db.run(
      "UPDATE tasks SET turn = ? WHERE job_id = ? AND state IN ('pending', 'leased') AND on_request = 0",
      turn, task.job_id);
}

void settle_turns(Tx& tx) {
  const Policy& policy = tx.options.policy;
  tx.db.run("DELETE FROM priority_quotas");
  tx.db.run("INSERT INTO priority_quotas (owner, most) VALUES ('', ?)", policy.everyone.priority);
  for (const auto& [owner, own] : policy.owners) {
    tx.db.run("INSERT INTO priority_quotas (owner, most) VALUES (?, ?)", owner, own.priority);
  }
  tx.db.run(
      "UPDATE queues SET rank = min(priority, coalesce("
      "(SELECT most FROM priority_quotas WHERE owner = queues.owner), ?))",
      policy.everyone.priority);
  if (tx.options.owner_order == OwnerOrder::kRoundRobin) return;
  tx.db.run("UPDATE tasks SET turn = 0 WHERE turn <> 0");
}

}  // namespace affskel::server
