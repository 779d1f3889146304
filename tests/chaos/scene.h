#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "ledger.h"
#include "stage.h"

namespace affskel::chaos {

/// What faults and load share: the stage, the ledger, names, and what went wrong.
class Scene {
 public:
  Scene(Stage& the_stage, const Catalogue& the_catalogue, Ledger& the_ledger, std::string the_prefix,
        std::uint64_t seed)
      : stage(the_stage),
        catalogue(the_catalogue),
        ledger(the_ledger),
        prefix(std::move(the_prefix)),
        random(seed) {}

  Stage& stage;
  const Catalogue& catalogue;
  Ledger& ledger;
  std::string prefix;  ///< of all names of this run
  std::mt19937_64 random;

  /// The job of a second or two that was under way when the fault came.
  std::string running_job;

  /// A name that no other submission has.
  std::string new_name() { return prefix + std::to_string(++names_); }
  /// 0 .. below - 1.
  std::size_t pick(std::size_t below) { return static_cast<std::size_t>(random() % below); }

  /// Something that the server acknowledged does not hold.
  void complain(const std::string& what);
  void complain(const std::vector<std::string>& all);
  std::vector<std::string> take_complaints();
  /// Something computed is not what it is without faults.
  void differ(const std::string& what);
  /// A thread of a fault waited too long.
  void hang(const std::string& what);
  std::vector<std::string> take_hangs();

  /// Submits once, and writes the answer down.
  /// @return the job's id, empty when nothing was acknowledged within the limit.
  std::string submit(const Api& api, const Submission& submission, Milliseconds limit);
  /// The same again and again until it is acknowledged.  @throws Hang.
  std::string submit_patiently(const Api& api, const Submission& submission);
  /// The field of a job that is done; compared with the undisturbed one.
  void compare_field(const Api& api, const std::string& id, std::size_t recipe);
  std::vector<std::string> take_differences();

 private:
  std::string whereabouts(const std::string& id) const;

  std::atomic<std::uint64_t> names_{0};
  std::mutex mutex_;
  std::vector<std::string> complaints_, differences_, hangs_;
};

}  // namespace affskel::chaos
