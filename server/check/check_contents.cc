#include "check/check_contents.h"

#include <numeric>
#include <string_view>

#include "affskel/v1/types.pb.h"
#include "check/field_faults.h"
#include "check/piece_faults.h"
#include "check/refined_faults.h"
#include "wire/artifact_kinds.h"

namespace affskel::server {
namespace {

void check_pieces(Database& db, FaultLog& faults) {
  find_mesh_faults(db, [&](const PieceFault& fault) {
    faults.add(fault.where, fault.what + ": submit the same file again, which mends it");
  });
  faults.end_kind();
  find_artifact_faults(db, [&](const PieceFault& fault) {
    faults.add(fault.where, fault.what + ": check --repair has it made again");
  });
  faults.end_kind();
}

void check_fields(Database& db, FaultLog& faults) {
  for_each_field(db, [&](const FieldShape& field) {
    find_field_faults(db, field, [&](const FieldFault& fault) {
      faults.add(fault.where, fault.what + ": all " + std::to_string(field.done) +
                                  " finished directions of " + std::to_string(field.directions) +
                                  " must be computed again; check --repair marks them so");
    });
    find_refined_faults(db, field, [&](const FieldFault& fault) {
      faults.add(fault.where, fault.what + ": the refinement must begin anew; check --repair sees to it");
    });
  });
  faults.end_kind();
}

// Messages

bool readable(google::protobuf::MessageLite&& message, std::string_view bytes) {
  return message.ParseFromArray(bytes.data(), static_cast<int>(bytes.size()));
}

/// @param sql names where and gives the message.
template <typename Message>
void check_messages(Database& db, FaultLog& faults, const char* sql) {
  Statement row = db.query(sql);
  while (row.step()) {
    if (!readable(Message(), row.blob(1))) faults.add(row.text(0), "a stored message cannot be read");
  }
  faults.end_kind();
}

void check_task_params(Database& db, FaultLog& faults) {
  for (const wire::ArtifactKindInfo& kind : wire::artifact_kinds()) {
    if (!kind.derived()) continue;
    Statement row = db.query("SELECT id, params FROM tasks WHERE kind = ?", kind.name());
    while (row.step()) {
      v1::Lease lease;
      if (!wire::set_task_params(kind.params, std::string(row.blob(1)), lease)) {
        faults.add("task " + row.text(0) + ", parameters", "a stored message cannot be read");
      }
    }
  }
  faults.end_kind();
}

void check_all_messages(Database& db, FaultLog& faults) {
  check_messages<v1::ErosionParams>(db, faults,
                                    "SELECT 'erosion ' || id || ', parameters', params FROM erosions");
  check_messages<v1::SkeletonParams>(db, faults,
                                     "SELECT 'job ' || id || ', skeleton parameters', skeleton FROM jobs");
  check_messages<v1::SkeletonQuality>(
      db, faults, "SELECT 'job ' || id || ', quality', quality FROM jobs WHERE quality IS NOT NULL");
  check_messages<v1::SkeletonQuality>(
      db, faults,
      "SELECT 'artefact ' || id || ', quality', quality FROM artifacts WHERE quality IS NOT NULL");
  check_task_params(db, faults);
}

/// The summary of the prepare stage against the columns that were taken from it.
void check_summaries(Database& db, FaultLog& faults) {
  Statement row = db.query(
      "SELECT 'erosion ' || id, prepared, points, directions, stride FROM erosions"
      " WHERE core_version IS NOT NULL");
  while (row.step()) {
    Columns columns(row);
    const std::string erosion = columns.text();
    const std::string_view prepared = columns.blob();
    const std::int64_t points = columns.integer(), directions = columns.integer();
    const std::int64_t stride = columns.integer();
    v1::PreparedSummary summary;
    if (!summary.ParseFromArray(prepared.data(), static_cast<int>(prepared.size()))) {
      faults.add(erosion + ", summary", "a stored message cannot be read");
    } else if (summary.points() != static_cast<std::uint64_t>(points) ||
               summary.directions() != static_cast<std::uint64_t>(directions)) {
      faults.add(erosion, "has " + std::to_string(points) + " points and " + std::to_string(directions) +
                              " directions, its summary says " + std::to_string(summary.points()) + " and " +
                              std::to_string(summary.directions()));
    }
    // Otherwise the order of work would come to some directions twice and to others never.
    if (std::gcd(stride, directions) != 1) {
      faults.add(erosion, "the stride " + std::to_string(stride) + " has a divisor in common with the " +
                              std::to_string(directions) + " directions");
    }
  }
  faults.end_kind();
}

}  // namespace

void check_contents(Database& db, FaultLog& faults) {
  check_pieces(db, faults);
  check_fields(db, faults);
  check_all_messages(db, faults);
  check_summaries(db, faults);
}

}  // namespace affskel::server
