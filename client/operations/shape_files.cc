// Files of points and surfaces of a job.

#include <algorithm>

#include "base/atomic_file.h"
#include "base/number_text.h"
#include "client/artifacts/skeleton_points.h"
#include "client/artifacts/solid_parts.h"
#include "client/artifacts/surface.h"
#include "client/files/read/input_file.h"
#include "client/files/write/glb_writer.h"
#include "client/files/write/shape_writer.h"
#include "client/operations/artifact_calls.h"
#include "client/operations/artifact_files.h"
#include "client/operations/job_notices.h"
#include "client/operations/shape_notices.h"
#include "client/text/job_facts.h"
#include "client/text/skeleton_text.h"
#include "client/text/words.h"
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

// write_points or write_surface.
using WriteShape = void (&)(FileFormat format, const ShapeFile& shape,
                            const std::vector<std::string>& comments, const WriteBytes& write);

// A file that is opened before its artefact is computed.
class ShapeOutput {
 public:
  ShapeOutput(const Destination& destination, std::span<const FileFormat> formats, const char* what)
      : format_(choose_format(destination, formats, what)), file_(destination.file) {}

  FileFormat format() const { return format_; }

  // @param job, what of the comments. @param key, how the parameters that made it.
  void write(WriteShape writer, const ShapeFile& shape, const v1::Job& job, const std::string& what,
             const std::string& key, const std::string& how, const v1::SkeletonQuality* quality = nullptr) {
    write_by([&](const std::vector<std::string>& comments,
                 const WriteBytes& write) { writer(format_, shape, comments, write); },
             job, what, key, how, quality);
  }

  template <class Writer>
  void write_by(const Writer& writer, const v1::Job& job, const std::string& what, const std::string& key,
                const std::string& how, const v1::SkeletonQuality* quality) {
    core::FileFacts facts = job_facts(job, what);
    facts.push_back({key, how});
    std::vector<std::string> comments = comment_lines(facts);
    if (quality != nullptr) {
      for (const auto& [name, value] : quality_lines(*quality))
        comments.push_back("quality " + name + ": " + value);
    }
    write_into(file_, [&](const WriteBytes& write) { writer(comments, write); });
    file_.commit();
  }

 private:
  const FileFormat format_;
  base::AtomicFile file_;
};

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

// Barriers are those of sheets; the job's own skeleton may be points.
void require_sheet(Session& session, const FetchRequest& request, const ChosenSkeleton& chosen) {
  if (!request.barrier && request.min_barrier == 0) return;
  if (!request.skeleton.operator_name.empty()) return;  // the server names what does not go with it
  const v1::Operator which =
      chosen.params ? chosen.params->operator_() : session.get_job(chosen.job).skeleton().operator_();
  if (wire::gives_sheet(which)) return;
  const std::string points = "the job's own skeleton, the points of " + operator_word(which);
  const std::string without =
      request.alpha > 0 ? "alpha without an operator is for " + points + "; leave it out for the ridge"
      : request.skeleton.threshold > 0
          ? "a threshold without an operator is for " + points +
                "; name the operator ridge, whose threshold is 5 radians"
          : "without an operator this is " + points + "; name the operator ridge";
  throw ClientError(ExitCode::kUsage, "barriers are for the sheets of ridge and chords, and " + without);
}

v1::FetchArtifactRequest surface_request(Session& session, const FetchRequest& request) {
  // An alpha shape is one of points.
  const ChosenSkeleton chosen = request.alpha > 0
                                    ? choose_skeleton(session, request.job, request.skeleton)
                                    : choose_shown_skeleton(session, request.job, request.skeleton);
  require_sheet(session, request, chosen);
  v1::FetchArtifactRequest asked = request_for(chosen.job, v1::ARTIFACT_KIND_SURFACE);
  v1::SurfaceParams& surface = *asked.mutable_surface();
  if (chosen.params) *surface.mutable_skeleton() = *chosen.params;
  surface.set_alpha(request.alpha);
  surface.set_barrier(request.barrier || request.min_barrier > 0);
  surface.set_min_barrier(request.min_barrier);
  return asked;
}

// A sheet comes with its quality, an alpha shape does not.
Notice empty_surface(const v1::SkeletonQuality* quality) {
  Notice empty = warning("EMPTY_SURFACE", "the surface is empty: ");
  if (quality == nullptr) {
    empty.message += "no three skeleton points are near enough; try a larger alpha or a smaller threshold";
  } else if (quality->advice().empty()) {
    empty.message += "no piece of the sheet is significant enough; try a smaller threshold";
  } else {
    empty.message += quality->advice();
    empty.to_try.assign(quality->to_try().begin(), quality->to_try().end());
  }
  return empty;
}

void require_place_for_curves(const ShapeFile& shape, FileFormat format, const Destination& destination) {
  if (!shape.mesh().triangles.empty() || shape.segments.empty() || holds_curves(format)) return;
  throw ClientError(ExitCode::kUsage,
                    "the skeleton is of curves alone, for which " + std::string(extension_of(format)) +
                        " has no place; .vtp, .ply and .obj have one",
                    destination.name());
}

// Formats that hold only points mean points; the others can hold a surface.
bool wants_surface(const FetchRequest& request) {
  if (request.eroded_form != FetchRequest::Form::kByExtension)
    return request.eroded_form == FetchRequest::Form::kSurface;
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
  output.write(write_points, shape_of(points), header.job(), "eroded solid", "level",
               eroded_params_text(asked.eroded()) + ", volume about " + base::rounded(volume, 6));
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
  output.write(write_surface, surface.shape, header.job(), "eroded solid", "level",
               eroded_params_text(asked.eroded()) + ", volume " + base::to_text(surface.volume));
  Fetched fetched{request.destination, "eroded", "triangle", surface.shape.mesh().triangles.size(),
                  header.job()};
  fetched.volume = surface.volume;
  if (fetched.items == 0) fetched.notices = empty_eroded(surface.quality.advice());
  return fetched;
}

// The mesh in another format than the one in which it was submitted.
Fetched convert_mesh(Session& session, const FetchRequest& request) {
  const FileFormat format = choose_format(request.destination, surface_formats(), "mesh");
  base::AtomicFile out(request.destination.file);
  v1::ArtifactHeader header;
  const std::string bytes = session.fetch_bytes(request_for(request.job, v1::ARTIFACT_KIND_MESH), &header);
  ShapeFile shape;
  shape.off = parse_mesh(bytes, "mesh of job " + header.job().id());
  const std::vector<std::string> comments = comment_lines(job_facts(header.job(), "mesh"));
  write_into(out, [&](const WriteBytes& write) { write_surface(format, shape, comments, write); });
  out.commit();
  return {request.destination, "mesh", "triangle", shape.mesh().triangles.size(), header.job()};
}

}  // namespace

Fetched fetch_skeleton(Session& session, const FetchRequest& request) {
  const ChosenSkeleton chosen = choose_skeleton(session, request.job, request.skeleton);
  ShapeOutput output(request.destination, skeleton_formats(), "skeleton");
  v1::FetchArtifactRequest asked = request_for(chosen.job, v1::ARTIFACT_KIND_SKELETON);
  if (chosen.params) *asked.mutable_skeleton() = *chosen.params;
  v1::ArtifactHeader header;
  const v1::SkeletonPoints points = parse_skeleton(fetch_patiently(session, asked, header, "skeleton"));
  const v1::SkeletonQuality* quality = points.has_quality() ? &points.quality() : nullptr;
  output.write(write_points, shape_of(points), header.job(), "affine skeleton", "operator",
               skeleton_params_text(chosen.params.value_or(header.job().skeleton())), quality);
  Fetched fetched{request.destination, "skeleton", "point", static_cast<std::uint64_t>(points.point_size()),
                  header.job()};
  fetched.notices = skeleton_notices(fetched.items, points.quality(), header.job());
  if (quality != nullptr) fetched.quality = *quality;
  return fetched;
}

Fetched fetch_surface(Session& session, const FetchRequest& request) {
  const v1::FetchArtifactRequest asked = surface_request(session, request);
  ShapeOutput output(request.destination, surface_formats(), "surface");
  v1::ArtifactHeader header;
  const FetchedSurface surface = parse_surface(fetch_patiently(session, asked, header, "surface"));
  const v1::SkeletonParams& params =
      asked.surface().has_skeleton() ? asked.surface().skeleton() : header.job().skeleton();
  const v1::SkeletonQuality* quality = wire::gives_sheet(params.operator_()) ? &surface.quality : nullptr;
  require_place_for_curves(surface.shape, output.format(), request.destination);
  output.write(write_surface, surface.shape, header.job(), "affine skeleton, triangulated", "operator",
               surface_params_text(params, asked.surface()), quality);
  Fetched fetched{request.destination, "surface", "triangle", surface.shape.mesh().triangles.size(),
                  header.job()};
  fetched.notices = lost_curves(surface.shape, output.format(), request.destination.name());
  if (holds_curves(output.format())) fetched.segments = surface.shape.segments.size();
  if (quality != nullptr) fetched.quality = *quality;
  if (fetched.items + fetched.segments == 0) fetched.notices.push_back(empty_surface(quality));
  return fetched;
}

namespace {

LimbedSurface limbed_surface(const v1::SolidParts& solid) {
  LimbedSurface limbed;
  limbed.surface = surface_of(solid);
  for (const std::uint32_t part : solid.triangle_part()) limbed.triangle_part.push_back(part - 1);
  const auto& xyz = solid.curve().xyz();
  for (int v = 0; v < xyz.size(); v += 3) limbed.places.push_back({xyz[v], xyz[v + 1], xyz[v + 2]});
  for (const v1::SolidPart& part : solid.parts()) {
    limbed.branches.emplace_back(part.vertices().begin(), part.vertices().end());
    limbed.radius.push_back(part.mean_radius());
  }
  return limbed;
}

v1::SkeletonParams curve_params(const FetchRequest& request) {
  v1::SkeletonParams params;
  params.set_operator_(v1::OPERATOR_CURVE);
  if (request.skeleton.operator_name == operator_word(v1::OPERATOR_CURVE))
    params.set_threshold(request.skeleton.threshold);
  return params;
}

// The curve as joints, with the surface that they move.
Fetched fetch_armature(Session& session, const FetchRequest& request, ShapeOutput& output) {
  v1::ArtifactHeader header;
  const v1::SolidParts solid =
      fetch_solid_parts(session, request.job, curve_params(request).threshold(), header);
  const LimbedSurface limbed = limbed_surface(solid);
  output.write_by([&](const std::vector<std::string>& comments,
                      const WriteBytes& write) { write_glb(limbed, comments, write); },
                  header.job(), "curve skeleton, as joints of the solid", "operator",
                  skeleton_params_text(curve_params(request)), &solid.curve().quality());
  Fetched fetched{request.destination, "curve", "triangle", limbed.surface.triangles.size(), header.job()};
  fetched.quality = solid.curve().quality();
  return fetched;
}

}  // namespace

Fetched fetch_curve(Session& session, const FetchRequest& request) {
  ShapeOutput output(request.destination, curve_formats(), "curve skeleton");
  if (output.format() == FileFormat::kGlb) return fetch_armature(session, request, output);
  v1::FetchArtifactRequest asked = request_for(request.job, v1::ARTIFACT_KIND_SURFACE);
  const v1::SkeletonParams params = curve_params(request);
  *asked.mutable_surface()->mutable_skeleton() = params;
  v1::ArtifactHeader header;
  const FetchedSurface curve = parse_surface(fetch_patiently(session, asked, header, "curve skeleton"));
  output.write(write_curve, curve.shape, header.job(), "curve skeleton", "operator",
               skeleton_params_text(params), &curve.quality);
  Fetched fetched{request.destination, "curve", "segment", curve.shape.segments.size(), header.job()};
  fetched.quality = curve.quality;
  if (fetched.items == 0) fetched.notices.push_back(empty_surface(&curve.quality));
  if (output.format() == FileFormat::kSwc && curve.quality.holes() > 0)
    fetched.notices.push_back(warning(
        "CUT_LOOPS",
        ".swc holds trees: " + base::counted(curve.quality.holes(), "loop") + " cut where it closes"));
  return fetched;
}

Fetched fetch_thickness(Session& session, const FetchRequest& request) {
  ShapeOutput output(request.destination, thickness_formats(), "thickness");
  v1::ArtifactHeader header;
  const v1::SolidParts parts = fetch_solid_parts(session, request.job, 0, header);
  ShapeFile shape = core::shape_of(surface_of(parts));
  shape.face_columns = {{"thickness", false, {parts.thickness().begin(), parts.thickness().end()}},
                        {"part", true, {parts.triangle_part().begin(), parts.triangle_part().end()}}};
  output.write(write_surface, shape, header.job(), "thickness of the solid", "thickness",
               "from each triangle along its optimal normal to the skeleton of ridge, mesh units");
  return {request.destination, "thickness", "triangle", shape.mesh().triangles.size(), header.job()};
}

Fetched fetch_eroded(Session& session, const FetchRequest& request) {
  return wants_surface(request) ? fetch_eroded_solid(session, request)
                                : fetch_eroded_points(session, request);
}

Fetched fetch_submitted_mesh(Session& session, const FetchRequest& request) {
  const std::string extension = request.destination.extension();
  if (!extension.empty() && extension != extension_of(FileFormat::kOff))
    return convert_mesh(session, request);
  const v1::ArtifactHeader header = session.fetch(
      request_for(request.job, v1::ARTIFACT_KIND_MESH),
      [&]() -> std::unique_ptr<ArtifactSink> { return std::make_unique<RawSink>(request.destination.file); });
  return {request.destination, "mesh", "byte", header.bytes(), header.job()};
}

}  // namespace affskel::client
