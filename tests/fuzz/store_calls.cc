// Calls of clients and workers in any order, with whatever they bring, restarts and pauses among them: the store
// refuses with a StoreError, and its database is sound afterwards.
#include <cstring>
#include <optional>

#include "bytes.h"
#include "check/check_database.h"
#include "database/errors.h"
#include "server/store_fixture.h"
#include "targets.h"

namespace affskel::fuzz {
namespace {

using namespace server;

constexpr int kMostCalls = 60;
constexpr std::uint32_t kPoints = 6, kDirections = 9;

class Scene {
 public:
  Scene() { open(); }

  void step(Bytes& bytes) {
    try {
      call(bytes.below(22), bytes);
    } catch (const StoreError& error) {
      if (error.code() == StoreError::Code::kDamaged || error.code() == StoreError::Code::kUnusable ||
          error.code() == StoreError::Code::kLost)
        throw Finding(std::string("the store takes its own rows for damaged: ") + error.what());
    }
  }

  void check() {
    store_.reset();
    check_database(directory_.path(),
                   [](const Fault& fault) { throw Finding(fault.where + ": " + fault.what); });
  }

 private:
  void open() {
    store_.reset();
    StoreOptions options;
    options.policy.everyone.quota.queued_jobs = 6;
    store_ = std::make_unique<Store>((directory_.path() / "affskel.db").string(), options, clock_);
  }

  void call(unsigned which, Bytes& bytes) {
    switch (which) {
      case 0:
      case 1:
        return submit(bytes);
      case 2:
      case 3:
        return lease(bytes);
      case 4:
      case 5:
        return report(bytes);
      case 6:
      case 7:
        return complete(bytes);
      case 8:
        return void(store_->fail(token(bytes), error(bytes), bytes.below(2) == 0, bytes.below(3)));
      case 9:
        return void(store_->give_back(token(bytes)));
      case 10:
        return void(store_->cancel(job(bytes)));
      case 11:
        return void(store_->resume(job(bytes)));
      case 12:
        return void(store_->remove(job(bytes)));
      case 13:
        return void(store_->pin(job(bytes), bytes.below(2) == 0));
      case 14:
        return fetch(bytes);
      case 15:
        return void(store_->renew(token(bytes)));
      case 16:
        return void(store_->verify(job(bytes), 0.01 * bytes.byte(), bytes.below(3)));
      case 17:
        return void(store_->resume_without(job(bytes), "worker-" + std::to_string(bytes.below(3))));
      case 18:
        return pass(bytes);
      case 19:
        return open();
      case 20:
        return refined(bytes);
      default:
        return stand(bytes);
    }
  }

  void submit(Bytes& bytes) {
    const std::string mesh = "OFF " + std::to_string(bytes.below(3)), source = "OFF source";
    v1::SubmitJobHeader header = submit_header(mesh, "job " + std::to_string(bytes.below(2)));
    header.set_owner(bytes.below(3) == 0 ? "bob" : "ada");
    header.set_priority(bytes.below(11));
    if (bytes.below(4) == 0) header.set_request_id("key " + std::to_string(bytes.below(2)));
    if (bytes.below(4) == 0) header.mutable_params()->set_minimum(v1::MINIMUM_INFIMUM);
    if (bytes.below(4) == 0) header.mutable_skeleton()->set_operator_(v1::OPERATOR_RIDGE);
    std::string sent = mesh;
    if (bytes.below(4) == 0) {
      const v1::SubmitJobHeader before = submit_header(source);
      header.mutable_repair()->set_source_sha256(before.mesh_sha256());
      header.mutable_repair()->set_source_bytes(before.mesh_bytes());
      header.mutable_repair()->add_steps()->set_code("flaps");
      sent += source;
    }
    jobs_.push_back(store_->submit(header, sent).job.id());
  }

  void lease(Bytes& bytes) {
    const std::string worker = "worker-" + std::to_string(bytes.below(3));
    const std::optional<v1::Lease> got =
        store_->lease(worker_identity(worker, std::to_string(bytes.below(8) / 7)), "", bytes.below(2) == 0);
    if (got) leases_.push_back(*got);
  }

  void report(Bytes& bytes) {
    const v1::Lease held = a_lease(bytes);
    v1::ReportErosionHeader header;
    header.set_token(held.token());
    header.set_block_done(bytes.below(2) == 0);
    for (unsigned n = bytes.below(3); n > 0; --n) {
      v1::PositionRange& done = *header.add_positions_done();
      done.set_begin(bytes.below(kDirections + 2));
      done.set_end(bytes.below(kDirections + 2));
    }
    const bool meant = bytes.below(2) == 0 && held.positions_size() > 0;
    v1::FieldRecords records;
    if (meant) {
      header.clear_positions_done();
      for (const v1::PositionRange& range : held.positions()) {
        *header.add_positions_done() = range;
        records.MergeFrom(made_up_records(held.job(), range.begin(), range.end()));
      }
    }
    for (unsigned n = meant ? 0 : bytes.below(6); n > 0; --n) {
      records.add_point(bytes.below(kPoints + 2));
      records.add_direction(bytes.below(kDirections + 2));
      records.add_erosion(number(bytes));
      records.add_area(number(bytes));
    }
    const Store::BlockLease block = store_->block_lease(held.token());
    RecordBatch batch(block.bounds.points, block.directions, block.bounds.volume);
    batch.append(records);
    batch.sort();
    if (bytes.below(4) == 0) store_->report_part(held.token(), batch);
    store_->report(header, batch);
  }

  void refined(Bytes& bytes) {
    const v1::Lease held = a_lease(bytes);
    v1::ReportErosionHeader header;
    header.set_token(held.token());
    v1::RefinedRecords records;
    const std::uint32_t first = bytes.below(kPoints), count = bytes.below(kPoints);
    for (std::uint32_t p = first; p < first + count; ++p) {
      records.add_point(p);
      records.add_erosion(bytes.below(2) == 0 ? 0.05 : number(bytes));
      records.add_slope(number(bytes));
      for (const double c : {0.0, 0.0, 1.0}) records.add_normal(c);
      for (int s = 0; s < 2; ++s) records.add_saddle(bytes.below(3) == 0 ? bytes.byte() : ~0U);
    }
    v1::PositionRange& done = *header.add_positions_done();
    done.set_begin(first);
    done.set_end(first + count);
    header.set_block_done(bytes.below(2) == 0);
    const Store::BlockLease block = store_->block_lease(held.token());
    RefinedBatch batch(block.bounds);
    batch.append(records);
    store_->report_refined(header, batch);
  }

  void complete(Bytes& bytes) {
    const v1::Lease held = a_lease(bytes);
    const std::string garbage(bytes.take(bytes.below(20)));
    if (held.kind() == v1::TASK_KIND_PREPARE && bytes.below(4) != 0) {
      PrepareResult result =
          prepare_result(held.token(), bytes.below(kPoints + 1), 1 + bytes.below(kDirections));
      if (bytes.below(8) == 0) result.header.set_order_stride(bytes.byte());
      return void(store_->complete(result.header, result.data));
    }
    v1::CompleteTaskHeader header = derive_header(held.token(), garbage, bytes.byte());
    if (bytes.below(8) == 0) header.set_sha256("no hash");
    store_->complete(header, garbage);
  }

  void fetch(Bytes& bytes) {
    v1::FetchArtifactRequest request;
    request.set_job(job(bytes).text);
    request.set_kind(static_cast<v1::ArtifactKind>(bytes.below(14)));
    if (bytes.below(2) == 0) request.mutable_skeleton()->set_threshold(bytes.below(20));
    const Store::ArtifactState state = store_->open_artifact(request);
    if (state.reader) read_all(*state.reader);
    if (state.task != 0 && bytes.below(2) == 0) store_->withdraw(state.task);
  }

  void pass(Bytes& bytes) {
    clock_.advance(std::int64_t{1000} * bytes.byte());
    store_->expire_leases();
    if (bytes.below(2) == 0) store_->release_worker("test-host", 4711);
    for (unsigned n = bytes.below(4); n > 0; --n) {
      store_->tidy();
      store_->retain();
    }
  }

  void stand(Bytes& bytes) {
    v1::Stance stance;
    stance.set_up(static_cast<v1::AxisDirection>(bytes.below(8)));
    stance.set_front(static_cast<v1::AxisDirection>(bytes.below(8)));
    store_->set_stance(job(bytes), stance);
  }

  JobRef job(Bytes& bytes) const {
    const unsigned which = bytes.below(8);
    if (which == 0) return {"@last"};
    if (which == 1) return {std::string(bytes.take(8))};
    return {jobs_.empty() ? "000000" : jobs_[which % jobs_.size()]};
  }

  v1::Lease a_lease(Bytes& bytes) const {
    const unsigned which = bytes.below(6);
    if (leases_.empty() || which == 0) return {};
    return leases_[leases_.size() - 1 - (which - 1) % std::min<std::size_t>(leases_.size(), 5)];
  }
  std::string token(Bytes& bytes) const { return a_lease(bytes).token(); }

  static v1::JobError error(Bytes& bytes) {
    v1::JobError error;
    error.set_code(bytes.below(2) == 0 ? "BAD_INPUT" : "INTERNAL");
    error.set_message(std::string(bytes.take(4)));
    return error;
  }

  // Any double.
  static double number(Bytes& bytes) {
    if (bytes.below(2) == 0) return 0.125 * bytes.byte();
    double value = 0;
    const std::string_view raw = bytes.take(sizeof value);
    std::memcpy(&value, raw.data(), raw.size());
    return value;
  }

  tests::TemporaryDirectory directory_;
  TestClock clock_;
  std::unique_ptr<Store> store_;
  std::vector<std::string> jobs_;
  std::vector<v1::Lease> leases_;
};

void run(std::string_view input) {
  Bytes bytes(input);
  Scene scene;
  for (int call = 0; call < kMostCalls && !bytes.empty(); ++call) scene.step(bytes);
  scene.check();
}

// The way of a job: submitted, prepared, eroded by blocks, derived, fetched, deleted.
std::vector<std::string> seeds() {
  const std::string submit = {0, 0, 0, 1, 5, 1, 1, 1, 1}, lease = {2, 0, 0, 0};
  const std::string prepare = {6, 1, 0, 1, 5, 8, 1}, block = {4, 1, 0, 0, 0, 1};
  const std::string derive = {6, 1, 3, 'a', 'b', 'c', 3, 1}, fetch = {14, 2, 5, 1, 0}, remove = {12, 0};
  std::string way = submit + lease + prepare;
  for (int n = 0; n < 4; ++n) way += lease + block;
  way += lease + derive + fetch;
  return {way + remove, way + std::string{19} + submit + std::string{10, 0, 11, 0},
          submit + lease + std::string{18, 100, 0, 2} + lease};
}

}  // namespace

const Target kStoreCalls = {"store_calls", seeds, run, 30};

}  // namespace affskel::fuzz
