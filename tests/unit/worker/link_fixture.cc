#include "link_fixture.h"

#include <spdlog/sinks/ostream_sink.h>
#include <spdlog/spdlog.h>

#include <algorithm>

#include "core/erosion/field.h"

namespace affskel::worker {

LogCapture::LogCapture() : before_(spdlog::default_logger()) {
  spdlog::set_default_logger(
      std::make_shared<spdlog::logger>("test", std::make_shared<spdlog::sinks::ostream_sink_mt>(lines_)));
}

LogCapture::~LogCapture() {
  spdlog::set_default_logger(before_);
}

std::string merged(const PreparedJob& prepared, const std::vector<FakeServer::Report>& reports) {
  std::vector<core::FieldValue> field(prepared.lattice().points);
  for (const FakeServer::Report& report : reports) {
    EXPECT_EQ(report.header.records(), static_cast<std::uint64_t>(report.records.point_size()));
    for (int i = 0; i < report.records.point_size(); ++i) {
      const core::FieldValue offered{report.records.erosion(i), report.records.area(i),
                                     report.records.direction(i)};
      core::FieldValue& kept = field[report.records.point(i)];
      if (offered.improves(kept)) kept = offered;
    }
  }
  std::string bytes;
  for (const core::FieldValue& value : field) {
    bytes.append(reinterpret_cast<const char*>(&value.erosion), 8);
    bytes.append(reinterpret_cast<const char*>(&value.area), 8);
    bytes.append(reinterpret_cast<const char*>(&value.direction), 4);
  }
  return bytes;
}

std::vector<std::uint64_t> positions(const std::vector<FakeServer::Report>& reports) {
  std::vector<std::uint64_t> all;
  for (const FakeServer::Report& report : reports) {
    for (const v1::PositionRange& range : report.header.positions_done()) {
      for (std::uint64_t p = range.begin(); p < range.end(); ++p) all.push_back(p);
    }
  }
  std::sort(all.begin(), all.end());
  return all;
}

}  // namespace affskel::worker
