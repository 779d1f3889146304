#include "store_fixture.h"

#include <cstdlib>
#include <cstring>
#include <stdexcept>

#include "wire/direction_order.h"
#include "wire/sha256.h"

namespace affskel::server {

v1::SubmitJobHeader submit_header(const std::string& mesh, const std::string& name) {
  v1::SubmitJobHeader header;
  header.set_name(name);
  header.set_owner("ada");
  header.set_priority(5);
  header.mutable_params()->mutable_sampling()->set_spacing(0.25);
  header.mutable_params()->set_repair(true);
  header.mutable_skeleton()->set_operator_(v1::OPERATOR_ZUCKER_HUMMEL);
  header.set_mesh_sha256(wire::sha256_hex(mesh));
  header.set_mesh_bytes(mesh.size());
  return header;
}

v1::FetchArtifactRequest artifact_request(const std::string& job, v1::ArtifactKind kind) {
  v1::FetchArtifactRequest request;
  request.set_job(job);
  request.set_kind(kind);
  return request;
}

v1::FetchArtifactRequest mesh_request(const std::string& job) {
  return artifact_request(job, v1::ARTIFACT_KIND_MESH);
}

v1::FetchArtifactRequest skeleton_request(const std::string& job, double threshold) {
  v1::FetchArtifactRequest request = artifact_request(job, v1::ARTIFACT_KIND_SKELETON);
  request.mutable_skeleton()->set_operator_(v1::OPERATOR_ZUCKER_HUMMEL);
  request.mutable_skeleton()->set_threshold(threshold);
  return request;
}

v1::WorkerIdentity worker_identity(const std::string& id, const std::string& core_version) {
  v1::WorkerIdentity worker;
  worker.set_id(id);
  worker.set_host("test-host");
  worker.set_pid(4711);
  worker.set_threads(1);
  worker.set_core_version(core_version);
  return worker;
}

PrepareResult prepare_result(const std::string& token, std::uint32_t points, std::uint32_t directions) {
  v1::Lattice lattice;
  for (double value : {0.0, 0.0, 0.0}) lattice.add_origin(value);
  for (double value : {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0}) lattice.add_axes(value);
  for (std::uint32_t size : {1U, 1U, points}) lattice.add_dims(size);
  lattice.add_run_start(0);
  lattice.add_run_length(points);
  v1::Directions set;
  for (std::uint32_t i = 0; i < 3 * directions; ++i) set.add_xyz(i % 3 == 0 ? 1.0 : 0.0);

  PrepareResult result;
  const std::string lattice_bytes = lattice.SerializeAsString();
  result.data = lattice_bytes + set.SerializeAsString();
  v1::CompleteTaskHeader& header = result.header;
  header.set_token(token);
  header.mutable_prepared()->set_triangles(directions);
  header.mutable_prepared()->set_volume(16.0);  // above every E that tests report
  header.mutable_prepared()->set_spacing(0.25);
  for (int axis = 0; axis < 3; ++axis) {
    header.mutable_prepared()->add_bbox_min(0.0);
    header.mutable_prepared()->add_bbox_max(1.0);
  }
  header.mutable_prepared()->set_points(points);
  header.mutable_prepared()->set_directions(directions);
  header.set_order_stride(wire::direction_stride(directions));
  header.set_lattice_bytes(lattice_bytes.size());
  header.set_bytes(result.data.size());
  header.set_sha256(wire::sha256_hex(result.data));
  return result;
}

v1::CompleteTaskHeader derive_header(const std::string& token, const std::string& data,
                                     std::uint64_t points) {
  v1::CompleteTaskHeader header;
  header.set_token(token);
  header.set_points(points);
  header.set_bytes(data.size());
  header.set_sha256(wire::sha256_hex(data));
  return header;
}

double made_up_erosion(std::uint32_t point, std::uint32_t direction) {
  // Few different values, so that ties between directions are common.
  return static_cast<double>((point * 2654435761U ^ direction * 40503U) % 7 + 1) / 8.0;
}

double made_up_area(std::uint32_t point, std::uint32_t direction) {
  return point * 1000.0 + direction;
}

v1::FieldRecords made_up_records(const v1::Job& job, std::uint64_t begin, std::uint64_t end) {
  v1::FieldRecords records;
  const std::uint64_t directions = job.directions_total();
  for (std::uint64_t position = begin; position < end; ++position) {
    const auto direction =
        static_cast<std::uint32_t>(wire::direction_at(position, job.order_stride(), directions));
    for (std::uint32_t point = 0; point < job.prepared().points(); ++point) {
      records.add_point(point);
      records.add_direction(direction);
      records.add_erosion(made_up_erosion(point, direction));
      records.add_area(made_up_area(point, direction));
    }
  }
  return records;
}

std::string expected_field(std::uint32_t points, std::uint32_t directions) {
  std::string field;
  for (std::uint32_t point = 0; point < points; ++point) {
    std::uint32_t best = 0;
    for (std::uint32_t direction = 1; direction < directions; ++direction) {
      if (made_up_erosion(point, direction) < made_up_erosion(point, best)) best = direction;
    }
    const double erosion = made_up_erosion(point, best);
    const double area = made_up_area(point, best);
    field.append(reinterpret_cast<const char*>(&erosion), 8);
    field.append(reinterpret_cast<const char*>(&area), 8);
    field.append(reinterpret_cast<const char*>(&best), 4);
  }
  return field;
}

std::string read_all(BlobReader& reader) {
  std::string all;
  for (std::string piece = reader.next(); !piece.empty(); piece = reader.next()) all += piece;
  EXPECT_EQ(all.size(), reader.bytes());
  EXPECT_EQ(wire::sha256_hex(all), reader.sha256());
  return all;
}

void StoreTest::open() {
  store_.reset();
  store_ = std::make_unique<Store>(database(), options_, clock_);
}

v1::Job StoreTest::submit(const std::string& mesh, const std::string& name) {
  return store_->submit(submit_header(mesh, name), mesh).job;
}

v1::Lease StoreTest::lease(const std::string& worker) {
  std::optional<v1::Lease> lease = store_->lease(worker_identity(worker), "", false);
  if (!lease) throw std::logic_error("expected work, found none");
  return *lease;
}

bool StoreTest::has_work(const std::string& worker) {
  const std::optional<v1::Lease> lease = store_->lease(worker_identity(worker), "", false);
  if (lease) store_->give_back(lease->token());
  return lease.has_value();
}

void StoreTest::prepare(std::uint32_t points, std::uint32_t directions) {
  const v1::Lease task = lease();
  ASSERT_EQ(task.kind(), v1::TASK_KIND_PREPARE);
  const PrepareResult result = prepare_result(task.token(), points, directions);
  store_->complete(result.header, result.data);
}

v1::ReportResponse StoreTest::report(const v1::Lease& lease, std::uint64_t begin, std::uint64_t end,
                                     bool block_done) {
  v1::PositionRange range;
  range.set_begin(begin);
  range.set_end(end);
  return report(lease, {range}, made_up_records(lease.job(), begin, end), block_done);
}

v1::ReportResponse StoreTest::report(const v1::Lease& lease, const std::vector<v1::PositionRange>& ranges,
                                     const v1::FieldRecords& records, bool block_done) {
  v1::ReportErosionHeader header;
  header.set_token(lease.token());
  for (const v1::PositionRange& range : ranges) *header.add_positions_done() = range;
  header.set_block_done(block_done);
  RecordBatch batch(static_cast<std::int64_t>(lease.job().prepared().points()),
                    static_cast<std::int64_t>(lease.job().directions_total()),
                    lease.job().prepared().volume());
  batch.append(records);
  batch.sort();
  return store_->report(header, batch).response;
}

void StoreTest::finish_block(const v1::Lease& lease) {
  for (int i = 0; i < lease.positions_size(); ++i) {
    report(lease, lease.positions(i).begin(), lease.positions(i).end(), i + 1 == lease.positions_size());
  }
}

void StoreTest::erode(std::uint32_t points, std::uint32_t directions) {
  prepare(points, directions);
  for (;;) {
    const v1::Lease task = lease();
    if (task.kind() != v1::TASK_KIND_ERODE) {
      store_->give_back(task.token());
      return;
    }
    finish_block(task);
  }
}

void StoreTest::derive(const std::string& data, std::uint64_t points) {
  const v1::Lease task = lease();
  ASSERT_TRUE(task.kind() == v1::TASK_KIND_SKELETON || task.kind() == v1::TASK_KIND_SURFACE);
  store_->complete(derive_header(task.token(), data, points), data);
}

v1::Job StoreTest::complete_job(std::uint32_t points, std::uint32_t directions, const std::string& name) {
  const v1::Job job = submit("OFF 1", name);
  erode(points, directions);
  derive();
  return store_->job(job.id());
}

std::string StoreTest::field(const std::string& job) {
  v1::FetchArtifactRequest request = artifact_request(job, v1::ARTIFACT_KIND_FIELD);
  return read_all(*store_->open_artifact(request).reader);
}

}  // namespace affskel::server
