#pragma once

#include <gtest/gtest.h>

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "store/clock.h"
#include "store/field.h"
#include "store/store.h"
#include "tools/temporary_directory.h"

namespace affskel::server {

/// Stands still until told otherwise.
class TestClock final : public Clock {
 public:
  std::int64_t wall_ms() const override { return 1'700'000'000'000 + elapsed_; }
  std::int64_t lease_ms() const override { return 1'700'000'000'000 + elapsed_; }
  void advance(std::int64_t ms) { elapsed_ += ms; }

 private:
  std::atomic<std::int64_t> elapsed_ = 0;
};

using tests::TemporaryDirectory;

v1::SubmitJobHeader submit_header(const std::string& mesh, const std::string& name = "body");

/// A request without parameters.
v1::FetchArtifactRequest artifact_request(const std::string& job, v1::ArtifactKind kind);
v1::FetchArtifactRequest mesh_request(const std::string& job);
v1::FetchArtifactRequest skeleton_request(const std::string& job, double threshold);

v1::WorkerIdentity worker_identity(const std::string& id = "worker-a", const std::string& core_version = "1");

/// A prepare result: a lattice of one run of `points` points, `directions` directions.
struct PrepareResult {
  v1::CompleteTaskHeader header;
  std::string data;
};
PrepareResult prepare_result(const std::string& token, std::uint32_t points, std::uint32_t directions);

/// Header of the result of a SKELETON or SURFACE task.
v1::CompleteTaskHeader derive_header(const std::string& token, const std::string& data, std::uint64_t points);

/// A made-up but deterministic value of E of a point under a direction, with many ties.
double made_up_erosion(std::uint32_t point, std::uint32_t direction);
double made_up_area(std::uint32_t point, std::uint32_t direction);

/// The records of all points under the directions at [begin, end) in the order of work of `job`.
v1::FieldRecords made_up_records(const v1::Job& job, std::uint64_t begin, std::uint64_t end);

/// The field that all directions together must give, as stored bytes.
std::string expected_field(std::uint32_t points, std::uint32_t directions);

std::string read_all(BlobReader& reader);

/// A store on a real file.
class StoreTest : public testing::Test {
 protected:
  StoreTest() { open(); }

  /// Closes the database and opens it again, as a restarted server would.
  void open();

  std::string database() const { return (directory_.path() / "affskel.db").string(); }

  v1::Job submit(const std::string& mesh = "OFF 1", const std::string& name = "body");
  v1::Lease lease(const std::string& worker = "worker-a");
  bool has_work(const std::string& worker = "worker-a");
  void prepare(std::uint32_t points, std::uint32_t directions);

  /// A report of positions [begin, end) with all their records.
  v1::ReportResponse report(const v1::Lease& lease, std::uint64_t begin, std::uint64_t end,
                            bool block_done = false);
  v1::ReportResponse report(const v1::Lease& lease, const std::vector<v1::PositionRange>& ranges,
                            const v1::FieldRecords& records, bool block_done = false);
  /// Everything that is left of a leased block.
  void finish_block(const v1::Lease& lease);
  /// Prepares and erodes; leaves the skeleton to be made.
  void erode(std::uint32_t points, std::uint32_t directions);
  /// Answers the derive task that is waiting.
  void derive(const std::string& data = "skeleton", std::uint64_t points = 3);
  /// From submission to the end.
  v1::Job complete_job(std::uint32_t points, std::uint32_t directions, const std::string& name = "body");

  std::string field(const std::string& job);

  TemporaryDirectory directory_;
  TestClock clock_;
  StoreOptions options_;
  std::unique_ptr<Store> store_;
};

}  // namespace affskel::server
