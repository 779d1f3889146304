#pragma once

#include <cstdint>
#include <string>

#include "store_fixture.h"

namespace affskel::server {

inline constexpr std::uint32_t kRefinePoints = 5000;  // two chunks
inline constexpr std::uint32_t kRefineDirections = 32, kRefineVertices = 12;

/// Made-up refined values: less and less points find something; in round 3 none does.
double refined_erosion(std::uint32_t point, std::uint32_t round);
v1::RefinedRecords refined_records(std::uint32_t begin, std::uint32_t end, std::uint32_t round);

/// The refined field after so many rounds, as stored bytes.
std::string expected_refined(std::uint32_t rounds);

/// A store with a job whose E is the infimum over all directions.
class RefineTest : public StoreTest {
 protected:
  v1::Job submit_infimum();
  /// Up to the first block of directions.
  v1::Job prepare_infimum();
  /// Up to the first block of round 0.
  v1::Job erode_infimum();

  v1::ReportErosionHeader header_of(const v1::Lease& lease, std::uint64_t begin, std::uint64_t end,
                                    bool done);
  v1::ReportResponse report_refined(const v1::ReportErosionHeader& header, const v1::RefinedRecords& records);
  v1::ReportResponse report_points(const v1::Lease& lease, std::uint64_t begin, std::uint64_t end,
                                   bool done = false);
  void finish_points(const v1::Lease& lease);
  /// Until the stage has come to round `until`, or to its end.
  void finish_rounds(const std::string& job, std::uint32_t until);

  std::string refined(const std::string& job);
};

}  // namespace affskel::server
