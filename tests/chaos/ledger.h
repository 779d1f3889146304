#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "affskel/v1/types.pb.h"

namespace affskel::chaos {

/// Where two byte strings differ first, for people; nothing when they are equal.
std::optional<std::string> difference(const std::string& bytes, const std::string& reference);

/// What the server acknowledged, and so must stand by.  Answers may be written down by several threads;
/// `audit` is for quiet moments, when no call that changes a job is under way.
class Ledger {
 public:
  /// What was last asked for and acknowledged.
  enum class Wish { kRun, kCancelled, kGone, kPerhapsGone };

  struct Entry {
    std::string name;
    std::string mesh_sha256;
    std::size_t recipe = 0;
    Wish wish = Wish::kRun;
    bool cancelled_for_good = false;  ///< the answer to the cancel said CANCELLED already
    v1::Job floor;                    ///< the furthest that was heard of it
    bool verified = false;            ///< its field was compared since it was done
  };

  /// The answer to a submission.  Returns what is wrong with it: another job's id, another mesh.
  std::vector<std::string> submitted(const std::string& name, const std::string& mesh_sha256,
                                     std::size_t recipe, const v1::Job& answer);
  /// Any other answer about a job.
  void saw(const v1::Job& job);
  void cancelled(const v1::Job& answer);
  void resumed(const v1::Job& answer);
  /// From now on it may be gone, or not.
  void deleting(const std::string& id);
  /// From now on it must be gone.
  void deleted(const std::string& id);
  void verified(const std::string& id);

  /// Compares with all jobs that the server has now, and takes them as the new floor.
  /// @return what is missing, has fallen back, or is what it should not be; empty when all is well.
  std::vector<std::string> audit(const std::vector<v1::Job>& jobs);

  std::map<std::string, Entry> entries() const;

 private:
  mutable std::mutex mutex_;
  std::map<std::string, Entry> entries_;  // by job id
};

}  // namespace affskel::chaos
