#include <algorithm>
#include <filesystem>
#include <limits>

#include "store/store_impl.h"
#include "wire/field_record.h"
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

std::map<std::string, std::int64_t> job_figures(Database& db) {
  std::map<std::string, std::int64_t> jobs;
  for (const std::string& state : wire::words(*v1::JobState_descriptor())) jobs[state] = 0;
  Statement row = db.query("SELECT state, count(*) FROM jobs GROUP BY state");
  while (row.step()) jobs[row.text(0)] = row.integer(1);
  return jobs;
}

std::map<std::string, std::int64_t> lease_figures(Database& db) {
  std::map<std::string, std::int64_t> leases;
  Statement row = db.query("SELECT kind, count(*) FROM tasks WHERE state = 'leased' GROUP BY kind");
  while (row.step()) leases[row.text(0)] = row.integer(1);
  return leases;
}

/// Jobs of one mesh or one field use it together.
std::vector<OwnerFigures> owner_figures(Database& db) {
  std::map<std::string, OwnerFigures> owners;
  Statement jobs =
      db.query("SELECT owner, count(*), total(state IN ('queued', 'running')) FROM jobs GROUP BY owner");
  while (jobs.step()) {
    OwnerFigures& of = owners[jobs.text(0)];
    of.owner = jobs.text(0);
    of.jobs = jobs.integer(1);
    of.active_jobs = static_cast<std::int64_t>(jobs.real(2));
  }
  Statement meshes = db.query(
      "SELECT owner, sum(bytes) FROM (SELECT DISTINCT j.owner, m.sha256, m.bytes FROM jobs j"
      " JOIN erosions e ON e.id = j.erosion_id JOIN meshes m ON m.sha256 = e.mesh_sha256) GROUP BY owner");
  while (meshes.step()) owners[meshes.text(0)].mesh_bytes = meshes.integer(1);
  Statement results = db.query(
      "SELECT k.owner, sum(iif(e.directions_done > 0, e.points * ?, 0)"
      " + (SELECT ifnull(sum(bytes), 0) FROM artifacts WHERE erosion_id = e.id))"
      " FROM (SELECT DISTINCT owner, erosion_id FROM jobs) k JOIN erosions e ON e.id = k.erosion_id"
      " GROUP BY k.owner",
      wire::kFieldRecordBytes);
  while (results.step()) owners[results.text(0)].result_bytes = results.integer(1);
  std::vector<OwnerFigures> sorted;
  for (auto& [name, owner] : owners) sorted.push_back(std::move(owner));
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const auto& a, const auto& b) { return a.jobs > b.jobs; });
  return sorted;
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
  figures.database_bytes = size_of(file_);
  figures.log_bytes = size_of(file_ + "-wal");
  figures.reserve_bytes = disk_full_ ? 0 : static_cast<std::int64_t>(options_.reserve_bytes);
  const std::uint64_t free = options_.free_bytes(std::filesystem::path(file_).parent_path().string());
  if (free != std::numeric_limits<std::uint64_t>::max()) figures.disk_free_bytes = free;
  return figures;
}

std::vector<BusyWith> Store::busy_with() {
  return read([](Database& db) {
    Statement row = db.query(
        "SELECT j.priority, j.owner, count(DISTINCT t.worker) FROM tasks t JOIN jobs j ON j.id = t.job_id"
        " WHERE t.state = 'leased' GROUP BY j.priority, j.owner");
    std::vector<BusyWith> busy;
    while (row.step()) busy.push_back({row.integer(0), row.text(1), row.integer(2)});
    return busy;
  });
}

}  // namespace affskel::server
