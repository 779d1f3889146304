#pragma once

#include <cstdint>
#include <string>

#include "affskel/v1/types.pb.h"
#include "affskel/v1/worker_service.pb.h"
#include "database/sqlite.h"

namespace affskel::server {

/// Memory that a worker needs for a task, bytes: an estimate that is rather too low, for a worker that finds
/// it too low says so, while work that no worker is offered waits in vain.
///
/// Before a mesh is read, from its bytes and the number of points asked for (a spacing tells none);
/// afterwards 235 bytes per triangle and 52 per sample point, and for a sheet 200 per point more.
std::uint64_t memory_need(v1::TaskKind kind, std::uint64_t mesh_bytes, const v1::ErosionParams& params,
                          const v1::PreparedSummary& prepared, v1::Operator shocks);

/// Rounded up to one of eight values between a power of two and the next, so that the queue has few different
/// ones; 0 below 64 MiB, which every worker has.
std::int64_t rounded_need(std::uint64_t bytes);

/// The rounded need of a task of a job in the database.  @param params of the derived kinds: serialized.
std::int64_t memory_need_of(Database& db, const std::string& job_id, v1::TaskKind kind,
                            const std::string& params);

}  // namespace affskel::server
