#include <algorithm>
#include <filesystem>
#include <limits>

#include "store/store_impl.h"
#include "wire/words.h"

namespace affskel::server {
namespace {

constexpr std::size_t kPriorities = 10;

std::vector<QueueFigures> queue_figures(Database& db, std::int64_t now_ms) {
  std::vector<QueueFigures> queue(kPriorities);
  for (std::size_t i = 0; i < kPriorities; ++i) queue[i].priority = static_cast<std::int64_t>(i);
  Statement jobs = db.query(
      "SELECT priority, count(*), min(queued_ms) FROM jobs WHERE state = 'queued' GROUP BY priority");
  while (jobs.step()) {
    QueueFigures& of = queue.at(static_cast<std::size_t>(jobs.integer(0)));
    of.jobs = jobs.integer(1);
    of.oldest_age_ms = std::max<std::int64_t>(0, now_ms - jobs.integer(2));
  }
  Statement tasks = db.query(
      "SELECT priority, count(*) FROM tasks WHERE state = 'pending' AND parked = 0 GROUP BY priority");
  while (tasks.step()) queue.at(static_cast<std::size_t>(tasks.integer(0))).tasks = tasks.integer(1);
  return queue;
}

std::map<std::int64_t, std::int64_t> need_figures(Database& db) {
  std::map<std::int64_t, std::int64_t> needs;
  Statement row = db.query("SELECT needs_memory, sum(ready) FROM queues GROUP BY needs_memory");
  while (row.step()) needs[row.integer(0)] = row.integer(1);
  return needs;
}

std::map<std::string, std::int64_t> job_figures(Database& db) {
  std::map<std::string, std::int64_t> jobs;
  for (const std::string& state : wire::words(*v1::JobState_descriptor())) jobs[state] = 0;
  Statement row = db.query("SELECT state, count(*) FROM jobs GROUP BY state");
  while (row.step()) jobs[row.text(0)] = row.integer(1);
  return jobs;
}

std::map<std::string, std::int64_t> lease_figures(Database& db) {
  std::map<std::string, std::int64_t> leases;
  for (const std::string& kind : wire::words(*v1::TaskKind_descriptor())) leases[kind] = 0;
  Statement row = db.query("SELECT kind, count(*) FROM tasks WHERE state = 'leased' GROUP BY kind");
  while (row.step()) leases[row.text(0)] = row.integer(1);
  return leases;
}

std::vector<OwnerFigures> owner_figures(Database& db) {
  std::vector<OwnerFigures> owners;
  Statement row = db.query(
      "SELECT owner, jobs, queued_jobs, mesh_bytes, stored_bytes - mesh_bytes"
      " FROM (SELECT owner, count(*) AS jobs FROM jobs GROUP BY owner) JOIN owner_use USING (owner)"
      " ORDER BY jobs DESC, owner");
  while (row.step()) {
    owners.push_back({row.text(0), row.integer(1), row.integer(2), row.integer(3), row.integer(4)});
  }
  return owners;
}

/// 0 when it is not there.
std::int64_t size_of(const std::string& file) {
  std::error_code error;
  const std::uintmax_t bytes = std::filesystem::file_size(file, error);
  return error ? 0 : static_cast<std::int64_t>(bytes);
}

}  // namespace

StoreFigures Store::figures() {
  StoreFigures figures = read([this](Database& db) {
    StoreFigures read;
    read.queue = queue_figures(db, clock_.wall_ms());
    read.needs = need_figures(db);
    read.jobs = job_figures(db);
    read.leases = lease_figures(db);
    read.requests =
        db.integer("SELECT count(*) FROM tasks WHERE on_request = 1 AND state IN ('pending', 'leased')")
            .value_or(0);
    read.owners = owner_figures(db);
    read.unused_bytes =
        db.integer("PRAGMA freelist_count").value_or(0) * db.integer("PRAGMA page_size").value_or(0);
    return read;
  });
  figures.disk = disk_figures();
  return figures;
}

DiskFigures Store::disk_figures() {
  DiskFigures disk;
  disk.database_bytes = size_of(file_);
  disk.log_bytes = size_of(file_ + "-wal");
  disk.reserve_bytes = disk_full_ ? 0 : static_cast<std::int64_t>(options_.reserve_bytes);
  const std::uint64_t free = options_.free_bytes(std::filesystem::path(file_).parent_path().string());
  if (free != std::numeric_limits<std::uint64_t>::max()) disk.free_bytes = free;
  return disk;
}

std::vector<BusyWith> Store::busy_with() {
  return read([this](Database& db) {
    Statement row = db.query(
        "SELECT j.priority, j.owner, count(DISTINCT t.worker) FROM tasks t JOIN jobs j ON j.id = t.job_id"
        " WHERE t.state = 'leased' GROUP BY j.priority, j.owner");
    std::vector<BusyWith> busy;
    while (row.step()) {
      const std::int64_t priority = row.integer(0);
      busy.push_back({priority, std::min(priority, options_.policy.of(row.text(1)).priority), row.text(1),
                      row.integer(2)});
    }
    return busy;
  });
}

}  // namespace affskel::server
