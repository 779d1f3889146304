#pragma once

#include <string>

#include "affskel/v1/worker_service.pb.h"
#include "job/prepared_job.h"

namespace affskel::worker {

/// A small torus as bytes, and leases on a job about it.
std::string sample_mesh();
v1::ErosionParams sample_params();
/// An ERODE lease on positions [begin, end) of the prepared job.
v1::Lease erode_lease(const PreparedJob& prepared, const std::string& token, std::uint64_t begin,
                      std::uint64_t end);
/// A lease of another kind on the same job, not prepared yet.
v1::Lease other_lease(const std::string& token, v1::TaskKind kind);
/// The same of the prepared job.
v1::Lease derive_lease(const PreparedJob& prepared, const std::string& token, v1::TaskKind kind);
/// The field's bytes when nothing is known of any point.
std::string empty_field(const PreparedJob& prepared);
/// The finished field's bytes, computed directly.
std::string finished_field(const PreparedJob& prepared);

}  // namespace affskel::worker
