#include "ledger.h"

#include <algorithm>
#include <set>
#include <utility>

namespace affskel::chaos {
namespace {

using Complaints = std::vector<std::string>;

bool holds(const v1::Job& job, const v1::PositionRange& range) {
  return std::any_of(job.done_positions().begin(), job.done_positions().end(), [&](const auto& done) {
    return done.begin() <= range.begin() && range.end() <= done.end();
  });
}

/// How far its refinement is: the round, and the points of it.
std::pair<std::uint32_t, std::uint64_t> refined(const v1::Job& job) {
  return {job.refine_round(), job.refined_points()};
}

/// Every direction that was done is done, and every point that was refined is.
bool holds_all(const v1::Job& job, const v1::Job& floor) {
  if (job.state() == v1::JOB_STATE_DONE) return true;  // all of them, which is looked at elsewhere
  return refined(job) >= refined(floor) && job.directions_done() >= floor.directions_done() &&
         std::all_of(floor.done_positions().begin(), floor.done_positions().end(),
                     [&](const auto& range) { return holds(job, range); });
}

bool further(const v1::Job& job, const v1::Job& floor) {
  if (job.state() == v1::JOB_STATE_DONE) return true;
  return floor.state() != v1::JOB_STATE_DONE && job.directions_done() >= floor.directions_done() &&
         refined(job) >= refined(floor);
}

void look_at_wish(const Ledger::Entry& entry, const v1::Job& job, Complaints& complaints) {
  const bool stopped = job.state() == v1::JOB_STATE_CANCELLED;
  if (entry.wish == Ledger::Wish::kRun && (stopped || job.cancel_requested())) {
    complaints.push_back(entry.name + ": cancelled, though nobody asked, or a resume was acknowledged");
  }
  // One that was only marked may have been done before its workers heard of it.
  const bool done_before = !entry.cancelled_for_good && job.state() == v1::JOB_STATE_DONE;
  if (entry.wish == Ledger::Wish::kCancelled && !stopped && !job.cancel_requested() && !done_before) {
    complaints.push_back(entry.name + ": its cancel was acknowledged, and it is " +
                         v1::JobState_Name(job.state()));
  }
}

void look_at(const Ledger::Entry& entry, const v1::Job& job, Complaints& complaints) {
  if (job.mesh_sha256() != entry.mesh_sha256) complaints.push_back(entry.name + ": another mesh");
  if (job.name() != entry.name) complaints.push_back(entry.name + ": now named " + job.name());
  if (entry.floor.state() == v1::JOB_STATE_DONE && job.state() != v1::JOB_STATE_DONE) {
    complaints.push_back(entry.name + ": was done, and is " + v1::JobState_Name(job.state()));
  }
  if (!holds_all(job, entry.floor)) {
    complaints.push_back(entry.name + ": " + std::to_string(entry.floor.directions_done()) +
                         " directions were done and " + std::to_string(entry.floor.refined_points()) +
                         " points of round " + std::to_string(entry.floor.refine_round()) +
                         ", not all of these are among the " + std::to_string(job.directions_done()) +
                         " and " + std::to_string(job.refined_points()) + " of round " +
                         std::to_string(job.refine_round()) + " of now");
  }
  if (job.state() == v1::JOB_STATE_DONE && job.directions_done() != job.directions_total()) {
    complaints.push_back(entry.name + ": done, without all of its directions");
  }
  // Workers lost many times in a row end a job by design, with its progress kept; LIMIT is said under memory
  // pressure.  The driver resumes these.
  const std::string& code = job.error().code();
  if (job.state() == v1::JOB_STATE_FAILED && code != "WORKER_LOST" && code != "LIMIT") {
    complaints.push_back(entry.name + ": failed, " + code + ": " + job.error().message());
  }
  look_at_wish(entry, job, complaints);
}

}  // namespace

std::optional<std::string> difference(const std::string& bytes, const std::string& reference) {
  if (bytes == reference) return std::nullopt;
  const auto [here, there] = std::mismatch(bytes.begin(), bytes.end(), reference.begin(), reference.end());
  return "byte " + std::to_string(here - bytes.begin()) + " of " + std::to_string(bytes.size()) +
         " is the first that differs from the " + std::to_string(reference.size()) + " of the reference";
}

std::vector<std::string> Ledger::submitted(const std::string& name, const std::string& mesh_sha256,
                                           std::size_t recipe, const v1::Job& answer) {
  const std::lock_guard lock(mutex_);
  Complaints complaints;
  for (const auto& [id, entry] : entries_) {
    if (entry.name == name && id != answer.id() && entry.wish != Wish::kGone) {
      complaints.push_back(name + ": acknowledged as " + id + " and now as " + answer.id());
    }
  }
  if (answer.name() != name || answer.mesh_sha256() != mesh_sha256) {
    complaints.push_back(name + ": answered by " + answer.id() + ", which is " + answer.name());
  }
  Entry& entry = entries_[answer.id()];
  entry.name = name;
  entry.mesh_sha256 = mesh_sha256;
  entry.recipe = recipe;
  if (further(answer, entry.floor)) entry.floor = answer;
  return complaints;
}

void Ledger::saw(const v1::Job& job) {
  const std::lock_guard lock(mutex_);
  const auto entry = entries_.find(job.id());
  if (entry != entries_.end() && further(job, entry->second.floor)) entry->second.floor = job;
}

void Ledger::cancelled(const v1::Job& answer) {
  const std::lock_guard lock(mutex_);
  Entry& entry = entries_.at(answer.id());
  entry.wish = Wish::kCancelled;
  entry.cancelled_for_good = answer.state() == v1::JOB_STATE_CANCELLED;
}

void Ledger::resumed(const v1::Job& answer) {
  const std::lock_guard lock(mutex_);
  entries_.at(answer.id()).wish = Wish::kRun;
}

void Ledger::deleting(const std::string& id) {
  const std::lock_guard lock(mutex_);
  entries_.at(id).wish = Wish::kPerhapsGone;
}

void Ledger::deleted(const std::string& id) {
  const std::lock_guard lock(mutex_);
  entries_.at(id).wish = Wish::kGone;
}

void Ledger::verified(const std::string& id) {
  const std::lock_guard lock(mutex_);
  entries_.at(id).verified = true;
}

std::vector<std::string> Ledger::audit(const std::vector<v1::Job>& jobs) {
  const std::lock_guard lock(mutex_);
  Complaints complaints;
  std::map<std::string, const v1::Job*> present;
  std::set<std::string> names;
  for (const v1::Job& job : jobs) {
    if (!present.emplace(job.id(), &job).second) complaints.push_back(job.name() + ": listed twice");
    if (!names.insert(job.name()).second) complaints.push_back(job.name() + ": two jobs of one submission");
  }
  for (auto& [id, entry] : entries_) {
    const auto found = present.find(id);
    if (entry.wish == Wish::kGone) {
      if (found != present.end()) complaints.push_back(entry.name + ": deleted, and is there again");
      continue;
    }
    if (found != present.end()) {
      look_at(entry, *found->second, complaints);
      entry.floor = *found->second;
    } else if (entry.wish != Wish::kPerhapsGone) {
      complaints.push_back(entry.name + ": acknowledged, and missing");
    }
  }
  return complaints;
}

std::map<std::string, Ledger::Entry> Ledger::entries() const {
  const std::lock_guard lock(mutex_);
  return entries_;
}

}  // namespace affskel::chaos
