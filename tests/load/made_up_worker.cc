#include "made_up_worker.h"

#include <algorithm>
#include <vector>

#include "tools/let_pass.h"
#include "wire/direction_order.h"
#include "wire/limits.h"
#include "wire/sha256.h"

namespace affskel::load {
namespace {

class MadeUpWorker {
 public:
  MadeUpWorker(const MadeUpWorkerOptions& options, const std::stop_token& stop, Calls& calls)
      : options_(options),
        stop_(stop),
        calls_(calls),
        stub_(v1::WorkerService::NewStub(connect(options.address))) {}

  void run() {
    while (!stop_.stop_requested()) {
      v1::LeaseTaskRequest request;
      v1::WorkerIdentity& worker = *request.mutable_worker();
      worker.set_id(options_.id);
      worker.set_host("load");
      worker.set_pid(1);
      worker.set_threads(1);
      worker.set_core_version("made-up");
      request.set_wait_ms(200);
      v1::LeaseTaskResponse response;
      if (lease(request, response) && response.has_lease()) work(response.lease());
    }
  }

 private:
  bool lease(const v1::LeaseTaskRequest& request, v1::LeaseTaskResponse& response) {
    const auto ask = [&] {
      grpc::ClientContext context;
      context.set_wait_for_ready(true);
      return stub_->LeaseTask(&context, request, &response);
    };
    // Where it waits for work, its time is none of the server's.
    return options_.work_waits ? calls_.timed("lease", ask) : ask().ok();
  }

  void work(const v1::Lease& lease) {
    if (lease.kind() == v1::TASK_KIND_PREPARE) return prepare(lease);
    if (lease.kind() == v1::TASK_KIND_ERODE) return erode(lease);
    v1::CompleteTaskHeader header;
    header.set_points(1);
    complete(lease, header, "skeleton");
  }

  void prepare(const v1::Lease& lease) {
    v1::Lattice lattice;
    for (const double value : {0.0, 0.0, 0.0}) lattice.add_origin(value);
    for (const double value : {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0}) lattice.add_axes(value);
    for (const std::uint32_t size : {1U, 1U, options_.points}) lattice.add_dims(size);
    lattice.add_run_start(0);
    lattice.add_run_length(options_.points);
    v1::Directions set;
    for (std::uint32_t i = 0; i < 3 * options_.directions; ++i) set.add_xyz(i % 3 == 0 ? 1.0 : 0.0);
    v1::CompleteTaskHeader header;
    v1::PreparedSummary& summary = *header.mutable_prepared();
    summary.set_triangles(12);
    summary.set_volume(2.0 + options_.points);  // above every E that it makes up
    summary.set_spacing(0.25);
    for (int axis = 0; axis < 3; ++axis) {
      summary.add_bbox_min(0);
      summary.add_bbox_max(1);
    }
    summary.set_points(options_.points);
    summary.set_directions(options_.directions);
    header.set_order_stride(wire::direction_stride(options_.directions));
    const std::string bytes = lattice.SerializeAsString();
    header.set_lattice_bytes(bytes.size());
    complete(lease, header, bytes + set.SerializeAsString());
  }

  void complete(const v1::Lease& lease, v1::CompleteTaskHeader& header, const std::string& data) {
    header.set_token(lease.token());
    header.set_bytes(data.size());
    header.set_sha256(wire::sha256_hex(data));
    calls_.timed("complete", [&] {
      grpc::ClientContext context;
      v1::ReportResponse response;
      const auto writer = stub_->CompleteTask(&context, &response);
      v1::CompleteTaskRequest request;
      *request.mutable_header() = header;
      writer->Write(request);
      request.set_data(data);
      writer->Write(request);
      writer->WritesDone();
      return writer->Finish();
    });
  }

  /// A position to a report: with its records, of which every direction improves some.
  void erode(const v1::Lease& lease) {
    std::uint64_t left = 0;
    for (const v1::PositionRange& range : lease.positions()) left += range.end() - range.begin();
    for (const v1::PositionRange& range : lease.positions()) {
      for (std::uint64_t p = range.begin(); p < range.end() && !stop_.stop_requested(); ++p) {
        tests::let_pass(options_.pause / options_.positions, stop_);
        if ((p + 1) % options_.positions == 0 || left == 1) {
          if (!report(lease, range.begin(), p + 1, left == 1)) return;
        }
        --left;
      }
    }
  }

  bool report(const v1::Lease& lease, std::uint64_t begin, std::uint64_t end, bool last) {
    v1::ReportErosionRequest header;
    header.mutable_header()->set_token(lease.token());
    v1::PositionRange* done = header.mutable_header()->add_positions_done();
    done->set_begin(begin);
    done->set_end(end);
    header.mutable_header()->set_block_done(last);
    const std::vector<v1::ReportErosionRequest> records = improved(end);
    std::size_t bytes = 0;
    for (const v1::ReportErosionRequest& message : records) bytes += message.ByteSizeLong();
    header.mutable_header()->set_records(std::min(options_.records, options_.points));
    const bool taken = calls_.timed("report", [&] {
      grpc::ClientContext context;
      v1::ReportResponse response;
      const auto writer = stub_->ReportErosion(&context, &response);
      writer->Write(header);
      for (const v1::ReportErosionRequest& message : records) writer->Write(message);
      writer->WritesDone();
      return writer->Finish();
    });
    if (taken) options_.acknowledged(bytes + header.ByteSizeLong());
    return taken;
  }

  /// Points all over the lattice, which every later position improves.
  std::vector<v1::ReportErosionRequest> improved(std::uint64_t end) const {
    std::vector<v1::ReportErosionRequest> messages;
    const std::uint32_t step = std::max(1U, options_.points / std::max(1U, options_.records));
    v1::FieldRecords* records = nullptr;
    for (std::uint32_t n = 0; n < std::min(options_.records, options_.points); ++n) {
      if (records == nullptr || records->point_size() == wire::kRecordsPerMessage) {
        records = messages.emplace_back().mutable_records();
      }
      const std::uint32_t point = n * step;
      records->add_point(point);
      records->add_direction(static_cast<std::uint32_t>((point + end) % options_.directions));
      records->add_erosion(1.0 / static_cast<double>(end + 1) + point);
      records->add_area(1);
    }
    return messages;
  }

  const MadeUpWorkerOptions& options_;
  const std::stop_token& stop_;
  Calls& calls_;
  std::unique_ptr<v1::WorkerService::Stub> stub_;
};

}  // namespace

void run_made_up_worker(const MadeUpWorkerOptions& options, const std::stop_token& stop, Calls& calls) {
  MadeUpWorker(options, stop, calls).run();
}

}  // namespace affskel::load
