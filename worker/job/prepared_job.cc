#include "job/prepared_job.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <set>

#include "base/number_text.h"
#include "core/base/error.h"
#include "core/infimum/refine.h"
#include "core/solid/solid_frame.h"
#include "core/text/off_file.h"
#include "wire/refined_record.h"
#include "wire/words.h"

namespace affskel::worker {
namespace {

static_assert(std::endian::native == std::endian::little,
              "field records are little-endian on disk and on the wire");

// Up to this many different directions are worth a warning: a cube's six normals give four times the E.
constexpr std::size_t kFewDirections = 40;

core::Solid read_solid(std::string_view bytes, const v1::ErosionParams& params, unsigned threads,
                       core::ExecutionContext* context, std::uint64_t& polygons_cut) {
  const core::OffMesh off = core::read_off(bytes, context);
  polygons_cut = off.polygons_cut;
  core::SolidOptions options;
  options.repair = params.repair();
  options.threads = threads;
  options.context = context;
  return core::make_solid(off.mesh, options, off.vertex_line, off.triangle_line);
}

core::FrameKind frame_kind(v1::Frame frame) {
  if (frame == v1::FRAME_UNSPECIFIED) return core::FrameKind::kAxis;
  const std::string word = wire::word(frame);
  if (!word.empty()) return core::parse_frame(word);
  core::refuse("frame " + std::to_string(frame) + " is not known to this worker");
}

core::DirectionSet take_directions(const core::Solid& solid, const std::string& spec,
                                   const core::Matrix3& frame) {
  core::DirectionOptions options;
  options.frame = frame;
  return core::make_directions(solid, spec.empty() ? "triangles" : spec, options);
}

core::Lattice lay_lattice(const core::Solid& solid, const v1::ErosionParams& params,
                          const core::Matrix3& frame, unsigned threads, core::ExecutionContext* context,
                          const std::function<std::uint64_t()>& available, double derive_bytes) {
  core::LatticeOptions options;
  // Asked here: the memory of the solid is taken already.
  if (available) options.memory_budget = available();
  options.point_bytes = core::kErosionBytesPerPoint + wire::kFieldRecordBytes;  // the server's field, fetched
  if (params.minimum() == v1::MINIMUM_INFIMUM)
    options.point_bytes = core::kRefineBytesPerPoint + wire::kRefinedRecordBytes;
  options.point_bytes = std::max(options.point_bytes, derive_bytes + wire::kFieldRecordBytes);
  const v1::Sampling& sampling = params.sampling();
  options.frame = frame;
  options.threads = threads;
  options.context = context;
  if (sampling.has_spacing()) {
    options.spacing = sampling.spacing();
  } else {
    options.target_points = sampling.target_points();
  }
  return core::make_lattice(solid, options);
}

void add(const core::Vec3& v, google::protobuf::RepeatedField<double>* list) {
  list->Add(v.x);
  list->Add(v.y);
  list->Add(v.z);
}

// Directions that differ by more than rounding.
std::size_t distinct(const core::DirectionSet& directions) {
  constexpr double kGrid = 1 << 20;
  std::set<std::array<std::int64_t, 3>> seen;
  for (const core::Vec3& d : directions) {
    seen.insert({std::llround(kGrid * d.x), std::llround(kGrid * d.y), std::llround(kGrid * d.z)});
    if (seen.size() > kFewDirections) break;
  }
  return seen.size();
}

static_assert(core::FieldValue::kNoDirection == wire::kNoDirection, "a point that no direction has reached");

// The records of a field in the server's form, without a copy of them all: there may be a great many.
template <class Visit>
void visit_field(std::string_view bytes, std::uint64_t points, Visit visit) {
  if (bytes.size() != points * wire::kFieldRecordBytes) {
    throw core::CoreError(core::CoreError::Code::kInternal, "the stored field has " +
                                                                std::to_string(bytes.size()) + " bytes for " +
                                                                std::to_string(points) + " points");
  }
  const char* at = bytes.data();
  for (std::uint32_t p = 0; p < points; ++p, at += wire::kFieldRecordBytes) {
    const wire::FieldRecord record = wire::decode_field_record(at);
    visit(p, core::FieldValue{record.erosion, record.area, record.direction});
  }
}

}  // namespace

PreparedJob::PreparedJob(std::string_view mesh_bytes, const v1::ErosionParams& params, unsigned threads,
                         core::ExecutionContext* context, const std::function<std::uint64_t()>& available,
                         double derive_bytes)
    : solid_(read_solid(mesh_bytes, params, threads, context, polygons_cut_)),
      volume_unit_(std::ldexp(1.0, 3 * solid_.exponent)),
      area_unit_(std::ldexp(1.0, 2 * solid_.exponent)),
      frame_(core::solid_frame(solid_, frame_kind(params.frame()), context)),
      lattice_(lay_lattice(solid_, params, frame_, threads, context, available, derive_bytes)),
      directions_(take_directions(solid_, params.directions(), frame_)) {}

v1::PreparedSummary PreparedJob::summary() const {
  v1::PreparedSummary summary;
  summary.set_triangles(solid_.mesh.triangles.size());
  summary.set_vertices(solid_.mesh.points.size());
  summary.set_components(solid_.shells.size());
  summary.set_solids(solid_.solid_volume.size());
  std::int64_t genus = 0;
  for (const core::Shell& shell : solid_.shells) genus += shell.genus;
  summary.set_cavities(solid_.shells.size() - solid_.solid_volume.size());
  summary.set_genus(genus);
  summary.set_volume(solid_.volume);
  add(solid_.bbox_min, summary.mutable_bbox_min());
  add(solid_.bbox_max, summary.mutable_bbox_max());
  summary.set_points(lattice_.points);
  summary.set_directions(directions_.size());
  summary.set_spacing(lattice_.spacing);
  for (const core::Vec3& axis : frame_) add(axis, summary.mutable_frame());
  if (polygons_cut_ != 0) {
    v1::MeshNote* note = summary.add_notes();
    note->set_severity("repaired");
    note->set_code("polygons-cut");
    note->set_message(base::counted(polygons_cut_, "face") + " with more than three sides " +
                      (polygons_cut_ == 1 ? "was" : "were") + " cut into triangles");
  }
  for (const core::MeshNote& found : solid_.notes) {
    v1::MeshNote* note = summary.add_notes();
    note->set_severity(core::severity_word(found.severity));
    note->set_code(found.code);
    note->set_message(found.message);
  }
  if (const std::size_t count = distinct(directions_); count <= kFewDirections) {
    v1::MeshNote* note = summary.add_notes();
    note->set_severity("warning");
    note->set_code("few-directions");
    note->set_message("the directions are only " + std::to_string(count) +
                      " different ones: E may come out several times too large, and the skeleton shows these "
                      "directions rather than the solid; add some, for example triangles+sphere:2000");
  }
  return summary;
}

v1::Lattice PreparedJob::lattice_message() const {
  v1::Lattice message;
  const core::SamplePlaces places(solid_, lattice_);
  add(places.origin(), message.mutable_origin());
  for (const core::Vec3& axis : places.axes()) add(axis, message.mutable_axes());
  for (std::uint32_t n : lattice_.grid.dims) message.add_dims(n);
  const std::uint64_t ny = lattice_.grid.dims[1], nz = lattice_.grid.dims[2];
  std::uint64_t end = 0;
  for (const core::LatticeRun& run : lattice_.axis[2].runs) {
    const std::uint64_t start = (run.start[0] * ny + run.start[1]) * nz + run.start[2];
    // Runs that touch (a surface passes between their points) are one run of the message.
    if (message.run_start_size() > 0 && start == end && run.start[2] != 0) {
      message.set_run_length(message.run_length_size() - 1,
                             message.run_length(message.run_length_size() - 1) + run.length);
    } else {
      message.add_run_start(start);
      message.add_run_length(run.length);
    }
    end = start + run.length;
  }
  return message;
}

v1::Directions PreparedJob::directions_message() const {
  v1::Directions message;
  message.mutable_xyz()->Reserve(static_cast<int>(3 * directions_.size()));
  for (const core::Vec3& d : directions_) add(d, message.mutable_xyz());
  return message;
}

wire::FieldRecord PreparedJob::record(const core::FieldValue& value) const {
  return {std::max(value.erosion * volume_unit(), std::numeric_limits<double>::min()),
          value.area * area_unit(), value.direction};
}

core::Erosion& PreparedJob::erosion(unsigned threads, std::string_view stored) {
  if (erosion_) return *erosion_;
  core::ErosionOptions options;
  options.threads = threads;
  options.track_changes = true;
  auto erosion = std::make_unique<core::Erosion>(solid_, lattice_, directions_, options);
  const double per_volume = volume_unit(), per_area = area_unit();
  if (!stored.empty()) {
    visit_field(stored, lattice_.points, [&](std::uint32_t p, const core::FieldValue& value) {
      if (value.direction == core::FieldValue::kNoDirection) return;
      erosion->field().offer(p, {value.erosion / per_volume, value.area / per_area, value.direction});
    });
  }
  erosion->field().take_changes([](std::uint32_t, const core::FieldValue&) {});  // the server knows these
  erosion_ = std::move(erosion);
  return *erosion_;
}

JobRefinement& PreparedJob::refinement(unsigned threads) {
  erosion_.reset();
  if (!refinement_)
    refinement_ =
        std::make_unique<JobRefinement>(solid_, lattice_, SolidUnits{volume_unit(), area_unit()}, threads);
  return *refinement_;
}

std::vector<core::FieldValue> unpack_field(std::string_view bytes, std::uint64_t points) {
  std::vector<core::FieldValue> values;
  values.reserve(bytes.size() / wire::kFieldRecordBytes);
  visit_field(bytes, points, [&](std::uint32_t, const core::FieldValue& value) { values.push_back(value); });
  return values;
}

}  // namespace affskel::worker
