// Files of a job's surfaces and of its eroded solids.

#include <algorithm>

#include "base/atomic_file.h"
#include "base/number_text.h"
#include "client/artifacts/skeleton_points.h"
#include "client/artifacts/solid_parts.h"
#include "client/artifacts/surface.h"
#include "client/files/read/input_file.h"
#include "client/files/write/shape_writer.h"
#include "client/operations/artifact_calls.h"
#include "client/operations/artifact_files.h"
#include "client/operations/job_notices.h"
#include "client/operations/shape_output.h"
#include "client/text/job_facts.h"
#include "client/text/skeleton_text.h"
#include "core/base/error.h"
#include "core/solid/solid.h"
#include "core/solid/turn_as_in.h"
#include "wire/params.h"

namespace affskel::client {
namespace {

namespace fs = std::filesystem;

class RawSink : public ArtifactSink {
 public:
  explicit RawSink(const fs::path& file) : file_(file) {}
  void begin(const v1::ArtifactHeader&) override {}
  void data(std::string_view bytes) override { file_.write(bytes); }
  void end() override { file_.commit(); }

 private:
  base::AtomicFile file_;
};

// v0 times the share of the sample points, so that all points give v0.  Cells of the lattice would give
// another sum, wrong where the solid is thin.
double volume_of_points(const v1::Job& job, int points) {
  const double all = static_cast<double>(std::max<std::uint64_t>(1, job.prepared().points()));
  return job.prepared().volume() * (points / all);
}

// Formats that hold only points mean points; the others can hold a surface.
bool wants_surface(const FetchRequest& request) {
  if (request.form != FetchRequest::Form::kByExtension) return request.form == FetchRequest::Form::kSurface;
  const std::string extension = request.destination.extension();
  const auto formats = surface_formats();
  return std::any_of(formats.begin(), formats.end(),
                     [&](FileFormat format) { return extension == extension_of(format); });
}

v1::FetchArtifactRequest eroded_request(const FetchRequest& request, v1::ArtifactKind kind) {
  v1::FetchArtifactRequest asked = request_for(request.job, kind);
  v1::ErodedParams& params = *asked.mutable_eroded();
  params = request.eroded;
  if (params.level_case() == v1::ErodedParams::LEVEL_NOT_SET) params.set_fraction(wire::kErodedFraction);
  return asked;
}

Notices empty_eroded(const std::string& advice) {
  return {warning("EMPTY_ERODED", "the eroded solid is empty: " +
                                      (advice.empty() ? "no sample point has such an E" : advice) +
                                      "; try a lower level")};
}

Fetched fetch_eroded_points(Session& session, const FetchRequest& request) {
  ShapeOutput output(request.destination, skeleton_formats(), "eroded solid's points");
  const v1::FetchArtifactRequest asked = eroded_request(request, v1::ARTIFACT_KIND_ERODED_POINTS);
  v1::ArtifactHeader header;
  const v1::SkeletonPoints points =
      parse_eroded_points(fetch_patiently(session, asked, header, "eroded solid"));
  const double volume = volume_of_points(header.job(), points.point_size());
  output.write(write_points, shape_of(points), header.job(),
               {"eroded solid", "level",
                eroded_params_text(asked.eroded()) + ", volume about " + base::rounded(volume, 6)});
  Fetched fetched{request.destination, "eroded", "point", static_cast<std::uint64_t>(points.point_size()),
                  header.job()};
  fetched.volume = volume;
  if (fetched.items == 0) fetched.notices = empty_eroded(points.quality().advice());
  return fetched;
}

Fetched fetch_eroded_solid(Session& session, const FetchRequest& request) {
  ShapeOutput output(request.destination, surface_formats(), "eroded solid's surface");
  const v1::FetchArtifactRequest asked = eroded_request(request, v1::ARTIFACT_KIND_ERODED_SURFACE);
  v1::ArtifactHeader header;
  const FetchedSurface surface = parse_surface(fetch_patiently(session, asked, header, "eroded solid"));
  output.write(write_surface, surface.shape, header.job(),
               {"eroded solid", "level",
                eroded_params_text(asked.eroded()) + ", volume " + base::to_text(surface.volume)});
  Fetched fetched{request.destination, "eroded", "triangle", surface.shape.mesh().triangles.size(),
                  header.job()};
  fetched.volume = surface.volume;
  if (fetched.items == 0) fetched.notices = empty_eroded(surface.quality.advice());
  return fetched;
}

// What bounds no solid, so that its job failed, stays as it is.
void turn_outward(core::Mesh& mesh) {
  try {
    core::turn_as_in(core::make_solid(mesh, {.check_self_intersections = false}), mesh);
  } catch (const core::CoreError&) {
  }
}

// A mesh in another format than the one in which it was submitted; that of a solid faces outward.
Fetched convert_mesh(Session& session, const FetchRequest& request, v1::ArtifactKind kind) {
  const FileFormat format = choose_format(request.destination, surface_formats(), "mesh");
  base::AtomicFile out(request.destination.file);
  v1::ArtifactHeader header;
  const std::string bytes = session.fetch_bytes(request_for(request.job, kind), &header);
  ShapeFile shape;
  shape.off = parse_mesh(bytes, "mesh of job " + header.job().id());
  if (kind == v1::ARTIFACT_KIND_MESH) turn_outward(shape.off.mesh);
  const std::vector<std::string> comments = comment_lines(job_facts(header.job(), request.artifact));
  write_into(out, [&](const WriteBytes& write) { write_surface(format, shape, comments, write); });
  out.commit();
  return {request.destination, request.artifact, "triangle", shape.mesh().triangles.size(), header.job()};
}

// OFF text byte for byte.
Fetched fetch_given(Session& session, const FetchRequest& request, v1::ArtifactKind kind) {
  const std::string extension = request.destination.extension();
  if (!extension.empty() && extension != extension_of(FileFormat::kOff))
    return convert_mesh(session, request, kind);
  const v1::ArtifactHeader header = session.fetch(
      request_for(request.job, kind),
      [&]() -> std::unique_ptr<ArtifactSink> { return std::make_unique<RawSink>(request.destination.file); });
  return {request.destination, request.artifact, "byte", header.bytes(), header.job()};
}

}  // namespace

Fetched fetch_thickness(Session& session, const FetchRequest& request) {
  ShapeOutput output(request.destination, thickness_formats(), "thickness");
  v1::ArtifactHeader header;
  // What is chosen for another operator is not for parts.
  const double threshold = request.skeleton.operator_name.empty() ? request.skeleton.threshold : 0;
  const v1::SolidParts parts = fetch_solid_parts(session, request.job, threshold, header);
  ShapeFile shape = core::shape_of(surface_of(parts));
  shape.face_columns = {{"thickness", false, {parts.thickness().begin(), parts.thickness().end()}},
                        {"part", true, {parts.triangle_part().begin(), parts.triangle_part().end()}}};
  const v1::SkeletonQuality& quality = parts.curve().quality();
  output.write(write_surface, shape, header.job(),
               {"thickness of the solid", "thickness",
                "from each triangle along its optimal normal to the skeleton of ridge, mesh units" +
                    (quality.advice().empty() ? "" : "; the skeleton: " + quality.advice())});
  Fetched fetched{request.destination, "thickness", "triangle", shape.mesh().triangles.size(), header.job()};
  fetched.quality = quality;
  fetched.notices = skeleton_notices(parts.curve(), header.job());
  return fetched;
}

Fetched fetch_eroded(Session& session, const FetchRequest& request) {
  return wants_surface(request) ? fetch_eroded_solid(session, request)
                                : fetch_eroded_points(session, request);
}

Fetched fetch_submitted_mesh(Session& session, const FetchRequest& request) {
  return fetch_given(session, request, v1::ARTIFACT_KIND_MESH);
}

Fetched fetch_source_mesh(Session& session, const FetchRequest& request) {
  return fetch_given(session, request, v1::ARTIFACT_KIND_SOURCE);
}

}  // namespace affskel::client
