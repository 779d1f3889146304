#pragma once

#include <prometheus/metric_family.h>

#include <cstdint>
#include <vector>

#include "calls/call_room.h"
#include "scheduling/worker_registry.h"
#include "store/store.h"

namespace affskel::server {

/// What a server has and does at the moment, as metrics: queue, owners, workers, connections, memory, disk.
/// Reads the database as readers do.
/// @param started_ms of the server, Unix time.
std::vector<prometheus::MetricFamily> figures_of(Store& store, const WorkerRegistry& registry,
                                                 const CallRoom& room, std::uint64_t started_ms);

}  // namespace affskel::server
