#include "services/figures.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>

#include "metrics/gauges.h"
#include "wire/version.h"

namespace affskel::server {
namespace {

double number(std::integral auto value) {
  return static_cast<double>(value);
}

void add_queue(Gauges& gauges, const StoreFigures& figures) {
  const auto by_priority = [&](const char* name, const char* help, auto value) {
    gauges.metric(name, help);
    for (const QueueFigures& of : figures.queue) {
      gauges.value(value(of), {{"priority", std::to_string(of.priority)}});
    }
  };
  by_priority("affskel_queue_jobs", "Jobs that wait for their first lease, by priority",
              [](const QueueFigures& of) { return number(of.jobs); });
  by_priority("affskel_queue_tasks", "Tasks that wait for a worker, by priority",
              [](const QueueFigures& of) { return number(of.tasks); });
  by_priority("affskel_queue_oldest_age_seconds",
              "Time that the first of the waiting jobs has waited, by priority; 0 when none waits",
              [](const QueueFigures& of) { return number(of.oldest_age_ms) / 1000; });
  gauges.metric("affskel_jobs", "Jobs in the database, by state");
  for (const auto& [state, jobs] : figures.jobs) gauges.value(number(jobs), {{"state", state}});
  gauges.metric("affskel_leases", "Leases that are held, by kind of task");
  for (const auto& [kind, leases] : figures.leases) gauges.value(number(leases), {{"kind", kind}});
  gauges.metric("affskel_artifact_requests", "Requests for artefacts that are yet to be made")
      .value(number(figures.requests));
}

/// Those with most jobs by name, all others together.
void add_owners(Gauges& gauges, std::vector<OwnerFigures> owners) {
  for (OwnerFigures& of : owners) of.owner = owner_label(of.owner);
  if (owners.size() > kMaxOwners) {
    OwnerFigures others{kOtherOwners, 0, 0, 0, 0};
    for (auto of = owners.begin() + kMaxOwners; of != owners.end(); ++of) {
      others.jobs += of->jobs;
      others.active_jobs += of->active_jobs;
      others.mesh_bytes += of->mesh_bytes;
      others.result_bytes += of->result_bytes;
    }
    owners.resize(kMaxOwners);
    owners.push_back(std::move(others));
  }
  const auto by_owner = [&](const char* name, const std::string& help, auto value) {
    gauges.metric(name, help + ", by owner; the owners beyond the 100 with most jobs together");
    for (const OwnerFigures& of : owners) gauges.value(number(value(of)), {{"owner", of.owner}});
  };
  by_owner("affskel_owner_jobs", "Jobs in the database", [](const OwnerFigures& of) { return of.jobs; });
  by_owner("affskel_owner_active_jobs", "Jobs queued or running",
           [](const OwnerFigures& of) { return of.active_jobs; });
  by_owner("affskel_owner_mesh_bytes", "Stored meshes", [](const OwnerFigures& of) { return of.mesh_bytes; });
  by_owner("affskel_owner_result_bytes", "Stored fields and artefacts",
           [](const OwnerFigures& of) { return of.result_bytes; });
}

void add_workers(Gauges& gauges, const std::vector<v1::WorkerInfo>& workers) {
  const auto count = [&](auto which) { return number(std::count_if(workers.begin(), workers.end(), which)); };
  gauges.metric("affskel_workers", "Workers heard from in the last minute, by what they do")
      .value(count([](const auto& w) { return !w.silent() && !w.task().empty(); }), {{"state", "busy"}})
      .value(count([](const auto& w) { return !w.silent() && w.task().empty(); }), {{"state", "idle"}})
      .value(count([](const auto& w) { return w.silent(); }), {{"state", "silent"}});
  double threads = 0;
  for (const v1::WorkerInfo& worker : workers) threads += worker.silent() ? 0 : worker.threads();
  gauges.metric("affskel_worker_threads", "Threads of the workers that are not silent").value(threads);
}

/// Nobody tells who waits for them: others' jobs go on.
void add_too_large(Gauges& gauges, const StoreFigures& figures,
                   const std::vector<WorkerRegistry::Present>& workers) {
  std::uint64_t most = 0;
  for (const WorkerRegistry::Present& worker : workers)
    most = std::max(most, worker.memory > 0 ? worker.memory : std::numeric_limits<std::uint64_t>::max());
  std::int64_t tasks = 0;
  for (const auto& [need, waiting] : figures.needs)
    if (!workers.empty() && static_cast<std::uint64_t>(need) > most) tasks += waiting;
  gauges
      .metric(
          "affskel_queue_too_large_tasks",
          "Tasks that wait for more memory than any of the workers that are there has; 0 while there is none")
      .value(number(tasks));
}

void add_calls(Gauges& gauges, const CallRoom& room) {
  gauges.metric("affskel_connections", "Connections that are open").value(number(room.connections.size()));
  gauges.metric("affskel_calls", "Calls under way").value(number(room.connections.calls()));
  const std::pair<const char*, const CallLimit*> kinds[] = {
      {"upload", &room.uploads}, {"download", &room.downloads}, {"wait", &room.waiting},
      {"watch", &room.watches},  {"report", &room.reports},     {"result", &room.results},
      {"input", &room.inputs},   {"poll", &room.polls}};
  gauges.metric("affskel_places_used_calls", "Places taken by calls under way, by kind of call");
  for (const auto& [kind, limit] : kinds) gauges.value(number(limit->used()), {{"kind", kind}});
  gauges.metric("affskel_places_limit_calls", "Places that there are for calls at once, by kind of call");
  for (const auto& [kind, limit] : kinds) gauges.value(number(limit->most()), {{"kind", kind}});
  gauges.metric("affskel_upload_memory_bytes", "Memory of meshes and results that are arriving")
      .value(number(room.upload_bytes.used()));
  gauges.metric("affskel_upload_memory_limit_bytes", "Memory that these may take")
      .value(number(room.upload_bytes.limit()));
  gauges.metric("affskel_report_memory_bytes", "Memory of reports that are arriving")
      .value(number(room.records_bytes.used()));
  gauges.metric("affskel_report_memory_limit_bytes", "Memory that these may take")
      .value(number(room.records_bytes.limit()));
}

void add_disk(Gauges& gauges, const StoreFigures& figures) {
  gauges.metric("affskel_database_bytes", "Size of the database file")
      .value(number(figures.disk.database_bytes));
  gauges.metric("affskel_database_log_bytes", "Size of the database's write-ahead log")
      .value(number(figures.disk.log_bytes));
  gauges.metric("affskel_database_unused_bytes", "Part of the database file that nothing is in")
      .value(number(figures.unused_bytes));
  gauges.metric("affskel_disk_reserve_bytes", "Room kept back for a full disk; 0 while the disk is full")
      .value(number(figures.disk.reserve_bytes));
  if (!figures.disk.free_bytes) return;
  gauges.metric("affskel_disk_free_bytes", "Free space where the database lies")
      .value(number(*figures.disk.free_bytes));
}

}  // namespace

std::vector<prometheus::MetricFamily> figures_of(Store& store, const WorkerRegistry& registry,
                                                 const CallRoom& room, std::uint64_t started_ms) {
  const StoreFigures figures = store.figures();
  Gauges gauges;
  add_queue(gauges, figures);
  add_owners(gauges, figures.owners);
  add_workers(gauges, registry.list());
  add_too_large(gauges, figures, registry.present());
  add_calls(gauges, room);
  add_disk(gauges, figures);
  gauges.metric("affskel_start_time_seconds", "Unix time of the server's start")
      .value(number(started_ms) / 1000);
  gauges.metric("affskel_build_info", "Version of the program and of the database's schema; always 1")
      .value(1, {{"schema", std::to_string(store.schema_version())}, {"version", wire::kVersion}});
  return gauges.take();
}

}  // namespace affskel::server
