#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "faults.h"
#include "ledger.h"
#include "load.h"
#include "stage.h"
#include "tally.h"

namespace affskel::chaos {

struct RunOptions {
  std::uint64_t seed = 1;
  std::vector<const Fault*> faults;  ///< in the order of injection
  std::string dir;                   ///< for sockets and logs, there already
  std::string data_dir;              ///< of the server
  bool tls = false;                  ///< TCP speaks TLS
};

/// One server's life under faults, from an empty data directory to the comparison of all that it holds.
class Run {
 public:
  Run(const Programs& programs, const Catalogue& catalogue, RunOptions options);

  /// Injects the faults and looks at the end; the outcomes go into the tally.
  /// @return whether all was well.
  bool go(Tally& tally);

 private:
  using Clock = std::chrono::steady_clock;

  Outcome disturb(const Fault& fault);
  /// Runs a step; what it throws is written down.
  void guarded(Outcome& outcome, const std::function<void()>& step);
  void make_sure_of_a_running_job();
  void recover(const Fault& fault, Outcome& outcome);
  void bring_up(std::uint32_t may_end, Outcome& outcome);
  void canary();
  void audit();
  /// Lists leave out which directions are done.
  static std::vector<v1::Job> with_progress(const Api& api, std::vector<v1::Job> jobs);
  void look_at_finished();
  void tidy_up();
  void collect(Outcome& outcome);
  void note(const std::string& what);

  Outcome end();
  void finish_all();
  void compare_all(const Api& api);
  void compare_artefacts(const Api& api, const std::string& id, const Ledger::Entry& entry);
  std::string leave_one_unfinished();
  void end_processes();
  void go_on_with_a_copy(const std::string& unfinished, Outcome& outcome);

  const Catalogue& catalogue_;
  RunOptions options_;
  Ledger ledger_;
  Stage stage_;
  Scene scene_;
  Load load_;
  std::string now_;  // what is going on, for notes
  bool good_ = true;
};

}  // namespace affskel::chaos
