#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "scene.h"

namespace affskel::chaos {

/// Processes that a fault may end though it does not kill them itself.
enum MayEnd : std::uint32_t { kNobody = 0, kServer = 1, kAWorker = 2 };

/// One kind of fault.  A job of a second or two is under way when it comes, and small ones are submitted
/// meanwhile.
struct Fault {
  const char* name;
  const char* what;           ///< what is done, for people
  bool (*inject)(Scene&);     ///< does it, and takes the cause away; false when it found nothing to disturb
  std::uint32_t may_end = 0;  ///< bits of MayEnd
};

/// All kinds, in the order of the table.  After each the service must come back by itself (dead processes are
/// started again), stand by all that it acknowledged, and compute the same fields.
const std::vector<Fault>& faults();

/// What no service can mend and the driver must notice: they show that it can fail.  Only drawn when named.
const std::vector<Fault>& sabotages();

/// So many faults: all kinds in a random order, then again in another, and so on.
std::vector<const Fault*> schedule(const std::vector<const Fault*>& kinds, std::size_t number,
                                   std::uint64_t seed);

/// Lets a fault last.
void last_for(Milliseconds time);
/// Beyond the lease: long enough for the server to take away what a silent worker held.
void outlast_lease();
/// Runs `work(0) .. work(number - 1)` in threads of their own, to their ends.
void in_parallel(std::size_t number, const std::function<void(std::size_t)>& work);

bool kill_server(Scene&);
bool kill_worker(Scene&);
bool kill_all(Scene&);
bool kill_server_amid_submissions(Scene&);
bool kill_submitting_client(Scene&);
bool kill_fetching_client(Scene&);
bool term_server(Scene&);
bool term_server_twice(Scene&);
bool kill_draining_server(Scene&);
bool term_worker(Scene&);
bool term_worker_twice(Scene&);
bool stop_server(Scene&);
bool stop_worker(Scene&);
bool stop_all(Scene&);
bool second_server(Scene&);

bool net_delay(Scene&);
bool net_throttle(Scene&);
bool net_reset(Scene&);
bool net_cut(Scene&);
bool net_close(Scene&);
bool net_half_close(Scene&);
bool net_black_hole(Scene&);
bool net_partition(Scene&);
bool net_refuse(Scene&);
bool garbage_connections(Scene&);
bool silent_connections(Scene&);
bool idle_connections(Scene&);

bool disk_full(Scene&);
bool no_space(Scene&);
bool write_error(Scene&);
bool sync_error(Scene&);
bool read_error(Scene&);
bool read_only(Scene&);
bool short_writes(Scene&);
bool memory_server(Scene&);
bool memory_worker(Scene&);
bool clock_forward(Scene&);
bool clock_back(Scene&);
bool clock_workers(Scene&);

bool duplicate_submissions(Scene&);
bool submit_storm(Scene&);
bool cancel_resume_storm(Scene&);
bool delete_storm(Scene&);
bool fetch_storm(Scene&);
bool stalled_fetches(Scene&);
bool watch_storm(Scene&);
bool slow_uploads(Scene&);
bool half_report(Scene&);
bool late_report(Scene&);

bool revoke_worker(Scene&);
bool revoke_client(Scene&);

bool poisoned_report(Scene&);
bool job_deleted_in_secret(Scene&);

}  // namespace affskel::chaos
