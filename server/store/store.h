#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <exception>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "access/gate.h"
#include "affskel/v1/client_service.pb.h"
#include "affskel/v1/worker_service.pb.h"
#include "base/mutex.h"
#include "database/database_file.h"
#include "database/reader_pool.h"
#include "store/blobs.h"
#include "store/clock.h"
#include "store/field.h"
#include "store/figures.h"
#include "store/refined.h"
#include "store/rows.h"
#include "store/submission.h"
#include "store/time_left.h"
#include "store/tx.h"

namespace affskel::server {

struct Seeker;

/// Longest id of a worker.
inline constexpr std::size_t kMaxWorkerIdBytes = 64;

/// @throws StoreError kInvalid when a worker does not identify itself as the contract says.
void check_worker(const v1::WorkerIdentity& worker);

/// The only writer of the database: jobs, their tasks and leases, fields and artefacts.
///
/// Every public function is one transaction, or part of one with others that came at the same time: when it
/// throws, nothing was changed; when it returns, the change is on the disk.  Thread-safe.  All throw
/// StoreError for what the caller did wrong and SqliteError for what the database did.  JOB in a parameter's
/// name means an id, a prefix or "@last".
class Store final : public TokenSource {
 public:
  /// Opens or creates `file`, migrates it, and gives every lease that a predecessor left a new deadline:
  /// its worker could not report while no server was there.
  /// @param listener, metrics may be null; must outlive the store.
  Store(std::string file, StoreOptions options, const Clock& clock, ChangeListener* listener = nullptr,
        Metrics* metrics = nullptr);

  const std::string& file() const { return file_; }
  const StoreOptions& options() const { return options_; }
  int schema_version() const { return schema_version_; }
  /// Whether the disk has no room for more than bookkeeping.
  bool disk_full() const { return disk_full_; }
  /// Bytes that have to be free before it is tried again to write for a job, where the disk is full, or something of
  /// the job was refused by it and has not been written since; else 0.
  std::uint64_t room_wanted(const std::string& job_id);
  /// Whether the database was removed or replaced by another file since it was opened.  Nothing is
  /// acknowledged from then on, and the process that runs the store should end.
  bool lost() const;

  // For clients: store_submit.cc, store_jobs.cc, store_keeping.cc, store_verify.cc

  struct Submitted {
    v1::Job job;
    bool existed = false;
  };
  /// Checks all of a header that can be checked without its mesh, its request id included.
  Submission check(const v1::SubmitJobHeader& header);
  /// Checks the bytes against the header and stores both, unless an earlier job answers the request.
  /// @param bytes of the mesh, followed by those of the mesh before its repair if it was repaired.
  Submitted submit(const Submission& submission, std::string_view bytes);
  Submitted submit(const v1::SubmitJobHeader& header, std::string_view bytes);

  v1::Job job(const JobRef& job_ref);
  std::string resolve(const JobRef& job_ref);
  JobPage list(const ListFilter& filter);
  /// What happened to a job, oldest first; only events with a number greater than `after`.
  v1::ListJobEventsResponse events(const JobRef& job_ref, std::int64_t after);
  /// A queued job is cancelled at once, a running one is marked.
  v1::Job cancel(const JobRef& job_ref);
  /// A failed or cancelled job goes on from where it was, and a done one whose results were removed begins
  /// anew; an active one stays as it is.
  v1::Job resume(const JobRef& job_ref);
  /// The same in any state, without what `worker` gave: see store/distrust.h.
  v1::Job resume_without(const JobRef& job_ref, const std::string& worker);
  /// Ids of workers, and names of hosts, that get no lease any more: see store/distrust.h.
  std::set<std::string> distrusted();
  /// Begins to have a `share` of the directions computed again, unless that is under way, or tells how far
  /// `verification` is: see store/verification.h.
  v1::Verification verify(const JobRef& job_ref, double share, std::int64_t verification);
  /// Keeps a job from retention, or no longer.
  v1::Job pin(const JobRef& job_ref, bool pinned);
  /// Keeps how its solid stands; an empty one: as its shape tells.
  /// @throws StoreError kInvalid when its directions lie along one axis, or one is missing.
  v1::Job set_stance(const JobRef& job_ref, const v1::Stance& stance);
  /// Deletes a job that is not active, and marks what no other job needs for tidy().  Returns its id.
  std::string remove(const JobRef& job_ref);

  struct Counts {
    std::int64_t queued = 0;
    std::int64_t running = 0;
    std::int64_t total = 0;
    std::int64_t requests = 0;  ///< artefacts that a client asked for and that are not there yet
  };
  Counts counts();
  /// The same for the jobs of one owner.
  Counts counts_of(const std::string& owner);

  /// The owners that the workers are busy with: a client that waits learns why from it.
  std::vector<BusyWith> busy_with();

  /// Everything that metrics tell of the database at the moment; takes no lock of writers: store_figures.cc.
  StoreFigures figures();
  DiskFigures disk_figures();

  // Artefacts: store_artifacts.cc

  /// An artefact that is there to be read, or a task that will bring it, or why the one asked for did not.
  struct ArtifactState {
    std::unique_ptr<BlobReader> reader;  ///< null = wait for `task`, unless `error` is set
    std::int64_t task = 0;
    std::optional<v1::JobError> error;
  };
  /// Opens a stored artefact; queues a task for a derived one that is not there yet.
  /// @param asked the task that an earlier call answered this request with, or 0.  When it has failed, the
  ///   answer is its error, and nothing is queued anew.
  /// @throws StoreError kNotFound when the job was deleted; kPrecondition when it is not as far yet, or the
  ///   request was cancelled; kInvalid for parameters out of range.
  ArtifactState open_artifact(const v1::FetchArtifactRequest& request, std::int64_t asked = 0);

  /// No call waits for what this task was to bring: takes a request back, also from the worker that has it.
  void withdraw(std::int64_t task);

  // For workers: store_leases.cc, store_reports.cc, store_complete.cc

  /// A worker that asks for work.
  struct LeaseAsk {
    const v1::WorkerIdentity& worker;
    std::string preferred_job;      ///< the one that it holds mesh and field of
    bool supervised = false;        ///< it was started by this server
    std::vector<std::string> held;  ///< tokens of leases, which are renewed first
  };
  struct LeaseAnswer {
    std::optional<v1::Lease> lease;  ///< of the task whose turn it is (store/turn.h), or nothing
    std::exception_ptr refused;      ///< a StoreError about this worker
  };
  /// Grants tasks to workers, in their order, in one transaction: each answer belongs to the ask at its
  /// place.
  std::vector<LeaseAnswer> lease_all(const std::vector<LeaseAsk>& asks);
  /// The same for one.
  std::optional<v1::Lease> lease(const v1::WorkerIdentity& worker, const std::string& preferred_job,
                                 bool supervised, const std::vector<std::string>& held = {});

  struct BlockLease {
    std::string job;
    std::string field;   ///< its name, see v1::Lease
    std::string worker;  ///< that holds it
    v1::TaskKind kind = v1::TASK_KIND_UNSPECIFIED;
    std::int64_t directions = 0;  ///< K
    RefinedBounds bounds;
  };
  /// What a leased ERODE or REFINE task is about, for checking a report while it arrives.
  BlockLease block_lease(const std::string& token);

  v1::ReportResponse renew(const std::string& token);
  /// Renews a lease that is there still; that it has ended or is to end, its worker hears otherwise.
  void keep_lease(const std::string& token);
  struct Reported {
    v1::ReportResponse response;
    /// The records are in the field, as the worker's.  Not those of a report that is repeated after its block was
    /// finished: nobody may hear of what is kept nowhere.
    bool merged = false;
  };
  Reported report(const v1::ReportErosionHeader& header, const RecordBatch& records);
  /// Merges a part of a report that is still arriving, and renews the lease.  What a record says is true
  /// whatever becomes of the rest; only report() calls positions done.  Returns whether it was merged.
  bool report_part(const std::string& token, const RecordBatch& records);
  /// The same of a REFINE task: what it calls done is stored with its values, see store/refinement.h.
  v1::ReportResponse report_refined(const v1::ReportErosionHeader& header, const RefinedBatch& batch);
  v1::ReportResponse complete(const v1::CompleteTaskHeader& header, std::string_view data);
  /// @param memory_needed bytes, when the worker has too little memory for the task: a larger one gets it.
  v1::ReportResponse fail(const std::string& token, const v1::JobError& error, bool retryable,
                          std::uint64_t memory_needed = 0);
  v1::ReportResponse give_back(const std::string& token);
  /// Opens an input of a leased task.
  /// @param known of REFINED: the round up to which the worker has what was found; none: it has nothing.
  std::unique_ptr<BlobReader> open_input(const std::string& token, v1::ArtifactKind kind,
                                         std::optional<std::int64_t> known = std::nullopt);

  // For the maintenance thread and the supervisor: store_leases.cc

  /// Requeues what leases held that have expired or made no progress; returns how many there were.  Takes
  /// back the requests for artefacts that a restart has left without a waiting call.
  int expire_leases();
  /// A worker process of this machine has ended: its leases are lost now, not at their deadline.
  int release_worker(const std::string& host, std::int64_t pid);

  /// One short step towards a database as small as what is in it: deletes a piece of what deleted jobs have
  /// left, gives pages back to the file system, shortens the log.  On a full disk, first looks whether there
  /// is room again.  True when the next step can be taken at once: store_space.cc.
  bool tidy();

  /// One short step of retention: removes what is due, or plans and tells what will be.  True when the next
  /// step can be taken at once.
  bool retain();

  // For the gate: store_tokens.cc

  std::optional<TokenRow> find_token(std::string_view token) override;
  bool has_tokens() override;
  std::vector<std::int64_t> invalid_tokens(const std::vector<std::int64_t>& ids,
                                           std::int64_t now_ms) override;
  void note_tokens_used(const std::map<std::int64_t, std::int64_t>& last_used_ms) override;
  /// Whether there is one that a caller could show now.
  bool has_valid_token();

  struct Holder {
    std::string host;
    std::int64_t pid = 0;
  };
  /// Supervised workers that hold leases, this server's or a predecessor's.
  std::vector<Holder> supervised_holders();
  /// Of requests for artefacts that wait for a worker, some at most.
  std::set<std::string> requested_jobs();

 private:
  /// What a caller wants to write.  It lives on the caller's stack, and is the business of the thread that
  /// commits it from its coming until it has ended.
  struct Change {
    explicit Change(std::function<void(Tx&)> what) : body(std::move(what)) {}

    const std::function<void(Tx&)> body;
    const std::chrono::steady_clock::time_point asked = std::chrono::steady_clock::now();
    Changes changes;           ///< of its last run
    bool room = true;          ///< it may write more than bookkeeping
    bool alone = false;        ///< it is not made with others
    bool undone = false;       ///< the database failed for its transaction
    std::exception_ptr error;  ///< why it cannot be made
    bool ended = false;        ///< under turn_mutex_
    std::condition_variable_any woken;
  };

  template <typename Body>
  auto write(Body&& body);
  void make(Change& change);
  void commit(Change& change);
  void wait_for_turn(Change& change);
  std::size_t next_together() const ABSL_EXCLUSIVE_LOCKS_REQUIRED(turn_mutex_);
  void commit_together(std::span<Change* const> together);
  void commit_all(std::span<Change* const> together);
  void run_change(Change& change, bool among_others) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  template <typename Body>
  auto write_field(const std::string& token, Body&& body);
  template <typename Body>
  auto read(Body&& body);

  void fail_damaged(const std::string& token, const std::string& why, bool retryable);
  void require_not_lost() const;
  void expect_orphans() ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  bool requests_turn(std::int64_t leased_requests, std::int64_t leased_blocks) const
      ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  std::optional<v1::Lease> grant_next(Tx& tx, const LeaseAsk& ask) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  std::optional<std::int64_t> choose_task(Database& db, const Seeker& seeker)
      ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void make_room(const Changes& undone);
  bool has_room() ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void note_stuck(const Changes& made);
  void forget_ended_stuck();
  void tell_full();
  void tell_room();
  void live_on_reserve() ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void notify_room();
  bool tidy_step();
  bool shorten_log();
  v1::ReportResponse complete_sample(const std::string& token, std::string_view fresh);
  v1::ReportResponse reply(bool cancelled) const;
  v1::Job write_job(const JobRef& job_ref, const std::function<void(Tx&, const JobRow&)>& change);

  const std::string file_;
  const StoreOptions options_;
  const Clock& clock_;
  ChangeListener* const listener_;
  Metrics* const metrics_;

  base::Mutex turn_mutex_;
  std::deque<Change*> turns_ ABSL_GUARDED_BY(turn_mutex_);  // the first are being made
  base::Mutex mutex_;
  DiskReserve reserve_ ABSL_GUARDED_BY(mutex_);
  Database db_ ABSL_GUARDED_BY(mutex_);
  ReaderPool readers_;
  int schema_version_ = 0;
  TimesLeft times_left_;
  OpenFile identity_;  // of the database and its log; set once
  /// Requests for artefacts that no client has asked for since the start.
  std::set<std::int64_t> orphans_ ABSL_GUARDED_BY(mutex_);
  std::int64_t orphans_until_ms_ ABSL_GUARDED_BY(mutex_) = 0;
  bool last_was_request_ ABSL_GUARDED_BY(mutex_) = false;  // the last grant, while jobs waited, too
  std::int64_t full_disk_ms_ ABSL_GUARDED_BY(mutex_) = 0;  // when the reserve was last needed
  std::atomic<bool> disk_full_ = false;                    // the reserve is given away
  std::atomic<bool> room_again_ = false;                   // and the callers were not told yet
  std::atomic<bool> untidy_ = true;                        // there may be something for tidy()
  std::atomic<std::uint64_t> room_wanted_ = 0;             // see room_wanted()
  base::Mutex stuck_mutex_;
  /// Tasks of which the last that was to be written, and is more than bookkeeping, found the disk full, and their jobs.
  std::map<std::int64_t, std::string> stuck_ ABSL_GUARDED_BY(stuck_mutex_);
  bool disk_full_told_ ABSL_GUARDED_BY(stuck_mutex_) = false;  // by the log, and not yet that there is room
};

}  // namespace affskel::server
