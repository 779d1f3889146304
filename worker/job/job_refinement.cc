#include "job/job_refinement.h"

#include <algorithm>
#include <limits>
#include <string>

#include "core/base/error.h"
#include "core/base/none.h"
#include "job/prepared_job.h"

namespace affskel::worker {
namespace {

static_assert(core::kNone == wire::kNoSaddle, "a saddle that is none");

[[noreturn]] void refuse(const std::string& why) {
  throw core::CoreError(core::CoreError::Code::kInternal, "the stored refined field " + why);
}

}  // namespace

wire::RefinedRecord refined_record(const core::LeastChord& least, const SolidUnits& units,
                                   std::uint32_t round) {
  wire::RefinedRecord record;
  record.erosion = std::max(least.erosion * units.volume, std::numeric_limits<double>::min());
  record.slope = least.slope * units.area;
  record.normal = {least.normal.x, least.normal.y, least.normal.z};
  record.saddles = least.saddles;
  record.round = round;
  return record;
}

core::LeastChord least_chord(const wire::RefinedRecord& record, const SolidUnits& units) {
  core::LeastChord least;
  least.erosion = record.erosion / units.volume;
  least.slope = record.slope / units.area;
  least.normal = {record.normal[0], record.normal[1], record.normal[2]};
  least.saddles = record.saddles;
  return least;
}

JobRefinement::JobRefinement(const core::Solid& solid, const core::Lattice& lattice, const SolidUnits& units,
                             unsigned threads)
    : units_(units), input_(solid, threads), rounds_(input_, lattice, threads) {}

void JobRefinement::take_seeds(std::string_view stored) {
  seeds_ = unpack_field(stored, rounds_.points());
  for (core::FieldValue& seed : seeds_) {
    if (seed.direction == core::FieldValue::kNoDirection) refuse("begins from one with points left out");
    seed.erosion /= units_.volume;
    seed.area /= units_.area;
  }
}

void JobRefinement::take_found(std::string_view stored, std::uint32_t through) {
  const std::size_t record_bytes = known_ ? wire::kRefinedPointRecordBytes : wire::kRefinedRecordBytes;
  const std::size_t count = stored.size() / record_bytes;
  if (stored.size() % record_bytes != 0 || (!known_ && count != rounds_.points()))
    refuse("has " + std::to_string(stored.size()) + " bytes for " + std::to_string(rounds_.points()) +
           " points");
  for (std::size_t i = 0; i < count; ++i) {
    const char* bytes = stored.data() + i * record_bytes;
    if (known_) {
      const wire::RefinedPointRecord named = wire::decode_refined_point_record(bytes);
      set(named.point, named.record);
    } else {
      set(i, wire::decode_refined_record(bytes));
    }
  }
  known_ = through;
  seeds_ = {};
}

void JobRefinement::set(std::uint64_t point, const wire::RefinedRecord& record) {
  if (point >= rounds_.points()) refuse("names point " + std::to_string(point));
  for (const std::uint32_t saddle : record.saddles) {
    if (saddle != wire::kNoSaddle && saddle >= input_.mesh.points.size())
      refuse("names saddle " + std::to_string(saddle));
  }
  rounds_.set({static_cast<std::uint32_t>(point), least_chord(record, units_)},
              static_cast<int>(record.round));
}

}  // namespace affskel::worker
