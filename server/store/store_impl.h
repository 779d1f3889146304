#pragma once

// Templates of Store, for its own source files only.

#include <spdlog/spdlog.h>

#include <optional>
#include <type_traits>
#include <utility>

#include "base/mutex.h"
#include "metrics/metrics.h"
#include "store/store.h"

namespace affskel::server {

/// Runs `body` in a transaction, maybe with those of others, and maybe more than once: nothing of what it did
/// before is kept then.  Returns when it is on the disk.
template <typename Body>
auto Store::write(Body&& body) {
  std::optional<std::invoke_result_t<Body&, Tx&>> result;
  Change change([&](Tx& tx) { result.emplace(body(tx)); });
  make(change);
  const Changes& changes = change.changes;
  if (changes.dropped) untidy_ = true;
  for (const std::string& line : changes.log) spdlog::info(line);
  if (metrics_ != nullptr) {
    for (const auto& count : changes.counts) count(*metrics_);
  }
  if (listener_ != nullptr) listener_->on_change(changes);
  return *std::move(result);
}

template <typename Body>
auto Store::read(Body&& body) {
  return readers_.read(body);
}

/// Points a job at another, finished erosion and drops its own; the job goes on in the derive stage.
void adopt_erosion(Tx& tx, const std::string& job_id, std::int64_t finished_erosion);

/// A finished erosion of this content that the owner has already, if there is one.  What others have computed
/// is computed again: a job that is done at once would tell that they have.
std::optional<std::int64_t> find_finished_erosion(Database& db, const std::string& owner,
                                                  const std::string& mesh_sha256,
                                                  const std::string& params_key,
                                                  const std::string& core_version);

/// Marks an erosion for deletion when no job needs it.
void drop_unused_erosion(Tx& tx, std::int64_t erosion_id);

}  // namespace affskel::server
