#include "loop/lease_loop.h"

#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>
#include <condition_variable>
#include <exception>
#include <optional>
#include <random>
#include <set>
#include <stop_token>
#include <utility>

#include "base/logfmt.h"
#include "base/mutex.h"
#include "base/service_manager.h"
#include "core/base/error.h"
#include "core/base/version.h"
#include "derive/derive.h"
#include "job/available_memory.h"
#include "job/prepared_job.h"
#include "job/result_bytes.h"
#include "job/task_limit.h"
#include "link/backoff.h"
#include "link/last_report.h"
#include "link/lease_keeper.h"
#include "link/server_link.h"
#include "link/task_context.h"
#include "loop/job_in_hand.h"
#include "tasks/erode_task.h"
#include "tasks/failure.h"
#include "tasks/refine_task.h"
#include "tasks/sample_task.h"
#include "wire/artifact_kinds.h"
#include "wire/direction_order.h"
#include "wire/identity.h"
#include "wire/words.h"

namespace affskel::worker {
namespace {

using Clock = std::chrono::steady_clock;
// For work, in one call: what idle workers cost the server.  Work that comes is given to the worker that
// waits at once.
constexpr auto kLongestWait = std::chrono::milliseconds(10000), kMinWait = std::chrono::milliseconds(1);
// Pauses after a task that failed but may be tried again.  They must be shorter than the silence after which
// the server counts a worker as silent.
constexpr auto kFirstRest = std::chrono::milliseconds(250);
constexpr auto kMaxRest = std::chrono::milliseconds(4000);
// Jobs on the shelf take a quarter of the memory at most; the rest is for the job in hand.
constexpr std::uint64_t kShelfShare = 4;

/// Enough of a lease's token to find its lines; the whole would let others report.
std::string short_token(const std::string& token) {
  return token.substr(0, 8);
}

v1::WorkerIdentity own_identity(const std::string& id, unsigned threads, std::uint64_t memory) {
  v1::WorkerIdentity identity;
  identity.set_id(id);
  identity.set_host(wire::host_name());
  identity.set_pid(static_cast<std::uint32_t>(getpid()));
  identity.set_threads(threads);
  identity.set_core_version(core::kCoreVersion);
  identity.set_memory(memory);
  return identity;
}

class LeaseLoop {
 public:
  LeaseLoop(const LeaseLoopOptions& options, std::stop_token stop)
      : options_(options),
        memory_(options.memory != 0 ? options.memory : available_memory()),
        stop_(stop),
        id_(wire::random_id()),
        link_({options.server, options.patience, id_, options.access}, stop),
        job_(link_, {.threads = options.threads,
                     .memory = options.memory,
                     .shelf_bytes = memory_ / kShelfShare,
                     .prepare_limit = options.prepare_limit}),
        last_report_([this](const std::string& token, const std::exception_ptr& problem) {
          report_failure(job_.id(), token, problem);  // forgetting the job is up to the waiting thread
        }) {
    *request_.mutable_worker() = own_identity(id_, options.threads, memory_);
  }

  base::ExitCode run() {
    spdlog::info(base::logfmt("ready", {{"worker", request_.worker().id()},
                                        {"server", options_.server},
                                        {"threads", options_.threads},
                                        {"memory", request_.worker().memory()}}));
    base::notify_service_manager(base::ServiceState::kReady);
    while (!stop_.stop_requested()) {
      const std::optional<v1::Lease> lease = next_lease();
      if (lease) {
        if (!accept(*lease)) break;
        work_on(*lease);
        last_work_ = Clock::now();
        continue;
      }
      if (options_.idle_exit.count() > 0 && idle_time_left().count() <= 0) {
        spdlog::info(base::logfmt("leaving", {{"worker", request_.worker().id()}, {"reason", "idle"}}));
        break;
      }
    }
    // Idle, or with jobs enough; a worker that is asked to leave says so at once, see run_lease_loop().
    if (!stop_.stop_requested()) base::notify_service_manager(base::ServiceState::kStopping);
    settle_last_report();
    give_back_next();
    return base::ExitCode::kDone;
  }

 private:
  std::optional<v1::Lease> next_lease() {
    if (!next_ && !last_report_.token().empty()) next_ = ask({}, {});
    if (next_) return std::exchange(next_, std::nullopt);
    settle_last_report();  // one that failed is said at once: its task may be all that there is to do
    return ask({}, options_.idle_exit.count() > 0 ? std::clamp(idle_time_left(), kMinWait, kLongestWait)
                                                  : kLongestWait);
  }

  // Tells in the request what the worker has in hand: a job, and leases.  One of them may have ended without
  // this worker's knowledge, and it must not be given its task as a new one.
  std::optional<v1::Lease> ask(const std::string& present, std::chrono::milliseconds wait) {
    request_.set_preferred_job(job_.id());
    request_.set_derived(known_.basis && known_.job == job_.id());
    request_.clear_held();
    for (const std::string& token : {present, last_report_.token()}) {
      if (!token.empty()) request_.add_held(token);
    }
    request_.set_wait_ms(static_cast<std::uint32_t>(wait.count()));
    return link_.lease(request_);
  }

  // Until the worker leaves for want of work, rounded up.
  std::chrono::milliseconds idle_time_left() const {
    return options_.idle_exit - std::chrono::floor<std::chrono::milliseconds>(Clock::now() - last_work_);
  }

  // Takes the next lease, if there is one, while the present one's task is still computed.
  void look_ahead(const v1::Lease& present) { next_ = ask(present.token(), {}); }

  // Waits until the last report has ended, and acts on how it did.
  void settle_last_report() {
    try {
      last_report_.wait();
    } catch (const LeaseLost& lost) {
      spdlog::warn(base::logfmt("lease_lost", {{"job", job_.id()}, {"message", lost.what()}}));
      forget();
    }
  }

  void give_back_next() {
    if (next_) link_.give_back(next_->token());
    next_.reset();
  }

  bool accept(const v1::Lease& lease) {
    if (options_.max_jobs != 0 && jobs_.count(lease.job().id()) == 0 && jobs_.size() == options_.max_jobs) {
      link_.give_back(lease.token());
      return false;
    }
    if (options_.max_jobs != 0) jobs_.insert(lease.job().id());
    return true;
  }

  void work_on(const v1::Lease& lease) {
    spdlog::debug(base::logfmt("leased", {{"job", lease.job().id()},
                                          {"kind", wire::word(lease.kind())},
                                          {"lease", short_token(lease.token())}}));
    TaskContext context(stop_);
    try {
      dispatch(lease, context);
      failures_.reset();
    } catch (const ServerGone&) {
      throw;
    } catch (const InputDamaged& damaged) {
      lose(lease, damaged.what());
      pause(failures_.next());
    } catch (const LeaseLost& lost) {
      // The call may have ended because of what the lease keeper found; the context knows.
      context.why() == TaskContext::Why::kCancelled ? drop(lease, context.why()) : lose(lease, lost.what());
    } catch (...) {
      const std::exception_ptr problem = std::current_exception();
      if (context.stop_requested()) {
        drop(lease, context.why());
      } else {
        forget();
        job_.clear_shelf();  // it may be memory that is short
        // At once, the task would most likely fail again, and a job has few attempts.
        if (report_failure(lease.job().id(), lease.token(), problem)) pause(failures_.next());
      }
    }
  }

  void pause(std::chrono::milliseconds time) {
    base::Mutex mutex;
    base::MutexLock lock(mutex);
    std::condition_variable_any().wait_for(lock, stop_, time, [] { return false; });
  }

  void lose(const v1::Lease& lease, const char* cause) {
    spdlog::warn(
        base::logfmt("lease_lost",
                     {{"job", lease.job().id()}, {"lease", short_token(lease.token())}, {"message", cause}}));
    forget();
    // Perhaps only the block before lost its lease.  Not given back, this one would lie idle until its
    // deadline.
    link_.give_back(lease.token());
  }

  // Ends a task that the context has stopped.
  void drop(const v1::Lease& lease, TaskContext::Why why) {
    switch (why) {
      case TaskContext::Why::kWorkerStops:
        return link_.give_back(lease.token());
      case TaskContext::Why::kLeaseLost:
        return lose(lease, "it was not renewed in time, or its job is gone");
      default:
        spdlog::info(base::logfmt(
            "task_dropped",
            {{"job", lease.job().id()}, {"lease", short_token(lease.token())}, {"message", "cancelled"}}));
        if (next_ && next_->job().id() == lease.job().id()) give_back_next();
        forget();
    }
  }

  // Whether the task will be tried again.
  bool report_failure(const std::string& job, const std::string& token, const std::exception_ptr& problem) {
    const Failure failure = describe(problem, request_.worker());
    spdlog::error(base::logfmt("task_failed", {{"job", job},
                                               {"lease", short_token(token)},
                                               {"code", failure.error.code()},
                                               {"message", failure.error.message()}}));
    v1::FailTaskRequest request;
    request.set_token(token);
    *request.mutable_error() = failure.error;
    request.set_retryable(failure.retryable);
    request.set_memory_needed(failure.memory_needed);
    try {
      link_.fail(request);
    } catch (const LeaseLost&) {
      // Another worker works on it already.
    }
    return failure.retryable;
  }

  void dispatch(const v1::Lease& lease, TaskContext& context) {
    const bool in_blocks = lease.kind() == v1::TASK_KIND_ERODE || lease.kind() == v1::TASK_KIND_REFINE;
    if (!in_blocks || std::exchange(kind_, lease.kind()) != lease.kind() || lease.job().id() != job_.id()) {
      const LeaseKeeper keeper(link_, lease, context);
      last_report_.wait();
    }
    const bool derives = wire::find_derived_kind(lease.kind()) != nullptr;
    if (!derives || known_.job != lease.job().id() || known_.field != lease.field()) known_ = {};
    switch (lease.kind()) {
      case v1::TASK_KIND_PREPARE:
        return prepare(lease, context);
      case v1::TASK_KIND_ERODE:
        return erode_block(lease, context);
      case v1::TASK_KIND_REFINE:
        return refine_block(lease, context);
      case v1::TASK_KIND_VERIFY:
        return verify(lease, context);
      default:
        if (wire::find_derived_kind(lease.kind()) != nullptr) return derive(lease, context);
        throw std::runtime_error("the server speaks of a task this worker does not know; update the worker");
    }
  }

  void prepare(const v1::Lease& lease, TaskContext& context) {
    const LeaseKeeper keeper(link_, lease, context);
    const PreparedJob& job = obtain(lease, context);
    v1::CompleteTaskHeader header;
    header.set_token(lease.token());
    *header.mutable_prepared() = job.summary();
    header.set_order_stride(wire::direction_stride(job.directions().size()));
    std::string data;
    append_result(data, job.lattice_message(), "the lattice (a wider spacing has fewer lines)");
    header.set_lattice_bytes(data.size());
    append_result(data, job.directions_message(), "the direction set (take fewer directions)");
    link_.complete(header, data);
  }

  void erode_block(const v1::Lease& lease, TaskContext& context) {
    PreparedJob* job = nullptr;
    core::Erosion* erosion = nullptr;
    {
      const LeaseKeeper keeper(link_, lease, context);
      job = &obtain(lease, context);
      require_same_job(lease, *job);
      // Of a field that nothing is known of there is nothing to learn.
      const std::string stored = job->has_erosion() || lease.job().directions_done() == 0
                                     ? std::string()
                                     : link_.fetch(lease.token(), v1::ARTIFACT_KIND_FIELD, context.token());
      core::throw_if_stopped(&context);
      erosion = &job->erosion(options_.threads, stored);
    }
    switch (erode(lease, *job, *erosion, link_, stop_, last_report_, [&] { look_ahead(lease); })) {
      case ErodeEnd::kBlockDone:
        break;
      case ErodeEnd::kStopped:
        link_.give_back(lease.token());
        break;
      case ErodeEnd::kCancelled:
        if (next_ && next_->job().id() == lease.job().id()) give_back_next();
        forget();
        break;
    }
  }

  void refine_block(const v1::Lease& lease, TaskContext& context) {
    const LeaseKeeper keeper(link_, lease, context);
    PreparedJob& job = obtain(lease, context);
    require_same_job(lease, job);
    refine(lease, job, options_.threads, link_, context, last_report_, [&] { look_ahead(lease); });
  }

  Derived derive_in_time(const v1::Lease& lease, const PreparedJob& job, std::string_view stored,
                         TaskContext& context) {
    TaskLimit limit(context, options_.derive_limit, kDeriving);
    try {
      return affskel::worker::derive(lease, job, stored, &limit, options_.derive_threads, &known_);
    } catch (const core::CoreError& error) {
      throw limit.reason(error);
    }
  }

  void derive(const v1::Lease& lease, TaskContext& context) {
    const LeaseKeeper keeper(link_, lease, context);
    const PreparedJob& job = obtain(lease, context);
    require_same_job(lease, job);
    const bool refined = lease.job().params().minimum() == v1::MINIMUM_INFIMUM;
    const std::string stored = link_.fetch(
        lease.token(), refined ? v1::ARTIFACT_KIND_REFINED : v1::ARTIFACT_KIND_FIELD, context.token());
    core::throw_if_stopped(&context);
    const Derived derived = derive_in_time(lease, job, stored, context);
    v1::CompleteTaskHeader header;
    header.set_token(lease.token());
    header.set_points(derived.items);
    if (derived.quality) *header.mutable_quality() = *derived.quality;
    link_.complete(header, derived.data);
  }

  void verify(const v1::Lease& lease, TaskContext& context) {
    const LeaseKeeper keeper(link_, lease, context);
    const PreparedJob& job = obtain(lease, context);
    require_same_job(lease, job);
    v1::CompleteTaskHeader header;
    header.set_token(lease.token());
    header.set_points(lease.job().prepared().points());
    link_.complete(header, sample_field(lease, job, context, options_.threads));
  }

  PreparedJob& obtain(const v1::Lease& lease, TaskContext& context) {
    if (!job_.is_of(lease)) last_report_.drop();
    return job_.obtain(lease, context);
  }

  void forget() {
    last_report_.drop();
    job_.forget();
    known_ = {};
  }

  LeaseLoopOptions options_;
  const std::uint64_t memory_;  // bytes that it may take; 0 = unknown
  std::stop_token stop_;
  const std::string id_;
  ServerLink link_;
  v1::LeaseTaskRequest request_;
  std::set<std::string> jobs_;
  Clock::time_point last_work_ = Clock::now();
  JobInHand job_;
  KnownRidges known_;  // while nothing but derivations comes
  Backoff failures_{kFirstRest, kMaxRest, std::random_device()()};
  LastReport last_report_;                         // uses job_
  v1::TaskKind kind_ = v1::TASK_KIND_UNSPECIFIED;  // of the last block
  std::optional<v1::Lease> next_;                  // taken ahead
};

}  // namespace

base::ExitCode run_lease_loop(const LeaseLoopOptions& options, std::stop_token stop) {
  const std::stop_callback stopping(stop,
                                    [] { base::notify_service_manager(base::ServiceState::kStopping); });
  try {
    return LeaseLoop(options, stop).run();
  } catch (const NotAllowed& refused) {
    spdlog::error(base::logfmt("not_allowed", {{"server", options.server}, {"message", refused.what()}}));
    return base::ExitCode::kNotAllowed;
  } catch (const ServerGone& gone) {
    if (stop.stop_requested()) return base::ExitCode::kDone;
    spdlog::error(base::logfmt("server_gone", {{"server", options.server}, {"message", gone.what()}}));
    return base::ExitCode::kUnreachable;
  }
}

}  // namespace affskel::worker
