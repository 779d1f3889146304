#include "client/commands/shared/transfer.h"

#include <algorithm>

#include "base/atomic_file.h"
#include "base/number_text.h"
#include "client/artifacts/divergence_writer.h"
#include "client/artifacts/field_writer.h"
#include "client/artifacts/skeleton_points.h"
#include "client/artifacts/surface.h"
#include "client/commands/shared/fetch_artifact.h"
#include "client/commands/shared/follow.h"
#include "client/commands/shared/shape_notes.h"
#include "client/files/read/input_file.h"
#include "client/files/write/shape_writer.h"
#include "client/text/job_facts.h"
#include "client/text/skeleton_text.h"
#include "client/text/words.h"
#include "core/lattice/lattice_coordinates.h"
#include "wire/params.h"

namespace affskel::client {
namespace {

namespace fs = std::filesystem;

// A field on its way into a file; a transfer that breaks off leaves nothing behind.
class FieldSink : public ArtifactSink {
 public:
  FieldSink(FileFormat format, const fs::path& file, const LatticePoints& points,
            const v1::Directions& directions, const v1::Job& job)
      : file_(file),
        writer_(format, file_, points, job.prepared().volume(), job_facts(job, "erosion field")),
        decoder_(points, directions, writer_) {}
  void begin(const v1::ArtifactHeader&) override {}
  void data(std::string_view bytes) override { decoder_.data(bytes); }
  void end() override {
    decoder_.finish();
    file_.commit();
  }

 private:
  base::AtomicFile file_;
  FieldWriter writer_;
  FieldDecoder decoder_;
};

class RawSink : public ArtifactSink {
 public:
  explicit RawSink(const fs::path& file) : file_(file) {}
  void begin(const v1::ArtifactHeader&) override {}
  void data(std::string_view bytes) override { file_.write(bytes); }
  void end() override { file_.commit(); }

 private:
  base::AtomicFile file_;
};

class DivergenceSink : public ArtifactSink {
 public:
  DivergenceSink(FileFormat format, const fs::path& file, const LatticePoints& points,
                 const core::FileFacts& facts)
      : file_(file), writer_(format, file_, points, facts) {}
  void begin(const v1::ArtifactHeader&) override {}
  void data(std::string_view bytes) override { writer_.data(bytes); }
  void end() override {
    writer_.finish();
    file_.commit();
  }

 private:
  base::AtomicFile file_;
  DivergenceWriter writer_;
};

// What a file says of itself.  @param key, how the parameters that made the artefact.
std::vector<std::string> comments_for(const v1::Job& job, const std::string& what, const std::string& key,
                                      const std::string& how, const v1::SkeletonQuality* quality = nullptr) {
  core::FileFacts facts = job_facts(job, what);
  facts.push_back({key, how});
  std::vector<std::string> comments = comment_lines(facts);
  if (quality != nullptr) {
    for (const auto& [name, value] : quality_lines(*quality))
      comments.push_back("quality " + name + ": " + value);
  }
  return comments;
}

// Refuses what cannot place a turned lattice, and says what most programs make of the others.
void check_grid(Context& context, FileFormat format, const LatticePoints& points,
                const Destination& destination) {
  try {
    core::check_places(format, points.grid());
  } catch (const core::CoreError& error) {
    throw ClientError(ExitCode::kUsage, error.what(), destination.name());
  }
  const bool by_matrix = format == FileFormat::kVtkHdf || format == FileFormat::kHdf;
  if (!by_matrix || core::is_upright(points.grid())) return;
  context.console().warning(
      destination.name() +
      ": the lattice is turned or sheared, and this format says so by the matrix Direction, which "
      "ParaView 5.11 and VTK 9.1 pass over; .vts holds the points themselves");
}

// The skeleton's parameters, and what of it the surface leaves out.
std::string surface_params_text(const v1::SkeletonParams& skeleton, const v1::SurfaceParams& surface) {
  const double least = surface.min_barrier();
  return skeleton_params_text(skeleton) + (least > 0 ? ", barriers from " + base::to_text(least) : "");
}

// v0 times the share of the sample points, so that all points give v0.  Cells of the lattice would give
// another sum, wrong where the solid is thin.
double volume_of_points(const v1::Job& job, int points) {
  const double all = static_cast<double>(std::max<std::uint64_t>(1, job.prepared().points()));
  return job.prepared().volume() * (points / all);
}

// The mesh in another format than the one in which it was submitted.
Written convert_mesh(Context& context, const std::string& job, FileFormat format,
                     const Destination& destination) {
  base::AtomicFile out(destination.file);
  v1::ArtifactHeader header;
  const std::string bytes = context.session().fetch_bytes(request_for(job, v1::ARTIFACT_KIND_MESH), &header);
  ShapeFile shape;
  shape.off = parse_mesh(bytes, "mesh of job " + header.job().id());
  const std::vector<std::string> comments = comment_lines(job_facts(header.job(), "mesh"));
  write_into(out, [&](const WriteBytes& write) { write_surface(format, shape, comments, write); });
  out.commit();
  return {destination, "mesh", "triangle", shape.mesh().triangles.size(), header.job()};
}

}  // namespace

FileFormat open_field_format(const v1::Job& job) {
  const auto& frame = job.prepared().frame();
  for (int i = 0; i < frame.size(); ++i) {
    if (frame[i] != (i % 4 == 0 ? 1 : 0)) return FileFormat::kVts;
  }
  return FileFormat::kVti;
}

Written transfer_field(Context& context, const std::string& job, const Destination& destination) {
  const FileFormat format = choose_format(destination, field_formats(), "field");
  const v1::Job now = context.session().get_job(job);
  // The finished field first: its absence is the error to report.
  if (now.state() != v1::JOB_STATE_DONE &&
      now.directions_done() < std::max<std::uint64_t>(1, now.directions_total())) {
    throw ClientError(ExitCode::kNotFound,
                      "there is no finished field: job " + now.id() + " " + unfinished_text(now));
  }
  const LatticePoints points(
      fetch_message<v1::Lattice>(context, now.id(), v1::ARTIFACT_KIND_LATTICE, "lattice"));
  check_grid(context, format, points, destination);
  const auto directions =
      fetch_message<v1::Directions>(context, now.id(), v1::ARTIFACT_KIND_DIRECTIONS, "direction set");
  const v1::ArtifactHeader header = context.session().fetch(
      request_for(now.id(), v1::ARTIFACT_KIND_FIELD), [&]() -> std::unique_ptr<ArtifactSink> {
        return std::make_unique<FieldSink>(format, destination.file, points, directions, now);
      });
  return {destination, "field", "point", points.count(), header.job()};
}

Written transfer_skeleton(Context& context, const std::string& job, const v1::SkeletonParams* skeleton,
                          const Destination& destination) {
  const FileFormat format = choose_format(destination, skeleton_formats(), "skeleton");
  base::AtomicFile out(destination.file);
  v1::FetchArtifactRequest request = request_for(job, v1::ARTIFACT_KIND_SKELETON);
  if (skeleton != nullptr) *request.mutable_skeleton() = *skeleton;
  v1::ArtifactHeader header;
  const v1::SkeletonPoints points = parse_skeleton(fetch_patiently(context, request, header, "skeleton"));
  const v1::SkeletonParams& params = skeleton ? *skeleton : header.job().skeleton();
  const v1::SkeletonQuality* quality = points.has_quality() ? &points.quality() : nullptr;
  const auto comments =
      comments_for(header.job(), "affine skeleton", "operator", skeleton_params_text(params), quality);
  write_into(out, [&](const WriteBytes& write) { write_points(format, shape_of(points), comments, write); });
  out.commit();
  Written written{destination, "skeleton", "point", static_cast<std::uint64_t>(points.point_size()),
                  header.job()};
  if (quality != nullptr) written.quality = *quality;
  return written;
}

Written transfer_surface(Context& context, const std::string& job, const v1::SurfaceParams& surface,
                         const Destination& destination) {
  const FileFormat format = choose_format(destination, surface_formats(), "surface");
  base::AtomicFile out(destination.file);
  v1::FetchArtifactRequest request = request_for(job, v1::ARTIFACT_KIND_SURFACE);
  *request.mutable_surface() = surface;
  v1::ArtifactHeader header;
  const FetchedSurface fetched = parse_surface(fetch_patiently(context, request, header, "surface"));
  const v1::SkeletonParams& params = surface.has_skeleton() ? surface.skeleton() : header.job().skeleton();
  const bool sheet = wire::gives_sheet(params.operator_());
  const auto comments =
      comments_for(header.job(), "affine skeleton, triangulated", "operator",
                   surface_params_text(params, surface), sheet ? &fetched.quality : nullptr);
  if (fetched.shape.mesh().triangles.empty() && !fetched.shape.segments.empty() && !holds_curves(format)) {
    throw ClientError(ExitCode::kUsage,
                      "the skeleton is of curves alone, for which " + std::string(extension_of(format)) +
                          " has no place; .vtp, .ply and .obj have one",
                      destination.name());
  }
  write_into(out, [&](const WriteBytes& write) { write_surface(format, fetched.shape, comments, write); });
  out.commit();
  tell_lost_curves(context.console(), fetched.shape, format, destination.name());
  Written written{destination, "surface", "triangle", fetched.shape.mesh().triangles.size(), header.job()};
  if (holds_curves(format)) written.segments = fetched.shape.segments.size();
  if (sheet) written.quality = fetched.quality;
  return written;
}

Written transfer_divergence(Context& context, const std::string& job, const v1::SkeletonParams* skeleton,
                            const Destination& destination) {
  const FileFormat format = choose_format(destination, divergence_formats(), "divergence");
  v1::FetchArtifactRequest request = request_for(job, v1::ARTIFACT_KIND_DIVERGENCE);
  if (skeleton != nullptr) *request.mutable_skeleton() = *skeleton;
  const v1::Job now = context.session().get_job(job);
  request.set_job(now.id());
  const LatticePoints points(
      fetch_message<v1::Lattice>(context, request.job(), v1::ARTIFACT_KIND_LATTICE, "lattice"));
  check_grid(context, format, points, destination);
  core::FileFacts facts = job_facts(now, "divergence of the optimal normals");
  facts.push_back({"operator", operator_word((skeleton ? *skeleton : now.skeleton()).operator_())});
  const v1::ArtifactHeader header = fetch_patiently(
      context, request,
      [&]() -> std::unique_ptr<ArtifactSink> {
        return std::make_unique<DivergenceSink>(format, destination.file, points, facts);
      },
      "divergence");
  return {destination, "divergence", "point", points.count(), header.job()};
}

Written transfer_eroded_points(Context& context, const std::string& job, const v1::ErodedParams& params,
                               const Destination& destination) {
  const FileFormat format = choose_format(destination, skeleton_formats(), "eroded solid's points");
  base::AtomicFile out(destination.file);
  v1::FetchArtifactRequest request = request_for(job, v1::ARTIFACT_KIND_ERODED_POINTS);
  *request.mutable_eroded() = params;
  v1::ArtifactHeader header;
  const v1::SkeletonPoints points =
      parse_eroded_points(fetch_patiently(context, request, header, "eroded solid"));
  const double volume = volume_of_points(header.job(), points.point_size());
  const auto comments =
      comments_for(header.job(), "eroded solid", "level",
                   eroded_params_text(params) + ", volume about " + base::rounded(volume, 6));
  write_into(out, [&](const WriteBytes& write) { write_points(format, shape_of(points), comments, write); });
  out.commit();
  Written written{destination, "eroded", "point", static_cast<std::uint64_t>(points.point_size()),
                  header.job()};
  written.volume = volume;
  written.advice = points.quality().advice();
  return written;
}

Written transfer_eroded_surface(Context& context, const std::string& job, const v1::ErodedParams& params,
                                const Destination& destination) {
  const FileFormat format = choose_format(destination, surface_formats(), "eroded solid's surface");
  base::AtomicFile out(destination.file);
  v1::FetchArtifactRequest request = request_for(job, v1::ARTIFACT_KIND_ERODED_SURFACE);
  *request.mutable_eroded() = params;
  v1::ArtifactHeader header;
  const FetchedSurface fetched = parse_surface(fetch_patiently(context, request, header, "eroded solid"));
  const auto comments =
      comments_for(header.job(), "eroded solid", "level",
                   eroded_params_text(params) + ", volume " + base::to_text(fetched.volume));
  write_into(out, [&](const WriteBytes& write) { write_surface(format, fetched.shape, comments, write); });
  out.commit();
  Written written{destination, "eroded", "triangle", fetched.shape.mesh().triangles.size(), header.job()};
  written.volume = fetched.volume;
  written.advice = fetched.quality.advice();
  return written;
}

Written transfer_mesh(Context& context, const std::string& job, const Destination& destination) {
  const FileFormat format = destination.extension().empty()
                                ? FileFormat::kOff
                                : choose_format(destination, surface_formats(), "mesh");
  if (format != FileFormat::kOff) return convert_mesh(context, job, format, destination);
  const v1::ArtifactHeader header = context.session().fetch(
      request_for(job, v1::ARTIFACT_KIND_MESH),
      [&]() -> std::unique_ptr<ArtifactSink> { return std::make_unique<RawSink>(destination.file); });
  return {destination, "mesh", "byte", header.bytes(), header.job()};
}

// Formats that hold only points mean points; the others can hold a surface.
bool holds_eroded_surface(const Destination& destination) {
  const std::string extension = destination.extension();
  const auto formats = surface_formats();
  return std::any_of(formats.begin(), formats.end(),
                     [&](FileFormat format) { return extension == extension_of(format); });
}

}  // namespace affskel::client
