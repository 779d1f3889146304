#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "affskel/v1/client_service.pb.h"
#include "store/givers.h"
#include "store/task_rows.h"
#include "store/turn.h"

namespace affskel::server {

/// Directions that the same workers gave, to be computed again by another in one task.
struct Sample {
  std::set<Giver> givers;
  std::vector<std::int64_t> positions;  ///< ascending
};

/// A sample of all directions of a finished field: of each set of workers that gave some the `share`, at
/// least one.  Which ones, is chance, but that with the most stored values is always among them: values that
/// are wrong everywhere are found however small the share.
/// @param share 0 < share <= 1.
std::vector<Sample> choose_samples(Database& db, const JobRow& job, double share);

/// Begins a verification with a task for each sample.  Returns its number.
std::int64_t begin_verification(Tx& tx, const JobRow& job, const std::vector<Sample>& samples);

/// The verification of a job that is under way, or 0.
std::int64_t verification_under_way(Database& db, const std::string& job);

/// How far a verification is.  @throws StoreError kNotFound when it is none of this job's.
v1::Verification verification_message(Database& db, const std::string& job, std::int64_t verification);

/// A ready sample that the worker may compute: it gave none of its directions.
std::optional<std::int64_t> sample_for(Database& db, const Seeker& seeker);

/// What came out of a sample.
struct SampleResult {
  std::int64_t compared = 0;   ///< stored values that one of its directions gave
  std::int64_t differing = 0;  ///< points
  std::string message;         ///< the first of these
};

/// Compares what a worker made of a sample with the stored field: no value may be less than the stored one,
/// and every stored one that a direction of the sample gave must have come out to the byte.
/// @param fresh the field of these directions alone.  @throws StoreError kInvalid when it is of another size.
SampleResult compare_sample(Database& db, const TaskRow& task, std::string_view fresh);

/// Keeps the result, and tells the job's events of it.
void finish_sample(Tx& tx, const TaskRow& task, const SampleResult& result);

/// The tasks of a job's samples are taken back.
void cancel_samples(Tx& tx, const std::string& job);

/// The task of a sample has failed for good.
void fail_sample(Tx& tx, const TaskRow& task, const std::string& why);

}  // namespace affskel::server
