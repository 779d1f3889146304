// Files of a job's skeletons: as a complex of triangles and curves, as points, as lines and what follows from them.

#include <algorithm>

#include "base/number_text.h"
#include "client/artifacts/skeleton_points.h"
#include "client/artifacts/solid_parts.h"
#include "client/artifacts/surface.h"
#include "client/base/error.h"
#include "client/files/write/glb_writer.h"
#include "client/operations/artifact_calls.h"
#include "client/operations/artifact_files.h"
#include "client/operations/job_notices.h"
#include "client/operations/shape_notices.h"
#include "client/operations/shape_output.h"
#include "client/text/skeleton_text.h"
#include "client/text/words.h"
#include "wire/params.h"

namespace affskel::client {
namespace {

using Form = FetchRequest::Form;

bool is_one_of(std::span<const FileFormat> formats, FileFormat format) {
  return std::find(formats.begin(), formats.end(), format) != formats.end();
}

// What alpha and barriers are of has triangles.
Form form_of(const FetchRequest& request) {
  const bool of_triangles = request.alpha > 0 || request.barrier || request.min_barrier > 0;
  return request.form == Form::kByExtension && of_triangles ? Form::kSurface : request.form;
}

// A sheet wherever triangles have a place; of points an alpha shape where nothing else has one.
bool wants_complex(const FetchRequest& request, const v1::SkeletonParams& params, FileFormat format) {
  if (const Form form = form_of(request); form != Form::kByExtension) return form == Form::kSurface;
  return is_one_of(surface_formats(), format) &&
         (wire::gives_sheet(params.operator_()) || !is_one_of(skeleton_formats(), format));
}

// Of a curve alone, what has a place for lines alone: .swc, say.
bool wants_lines(Session& session, const FetchRequest& request) {
  const auto has = [extension = request.destination.extension()](std::span<const FileFormat> formats) {
    return std::any_of(formats.begin(), formats.end(),
                       [&](FileFormat format) { return extension == extension_of(format); });
  };
  if (form_of(request) != Form::kByExtension || has(skeleton_file_formats()) || !has(curve_file_formats()))
    return false;
  const std::string& named = request.skeleton.operator_name;
  return (named.empty() ? session.get_job(request.job).skeleton().operator_() : operator_named(named)) ==
         v1::OPERATOR_CURVE;
}

std::span<const FileFormat> formats_of(Form form) {
  return form == Form::kSurface  ? surface_formats()
         : form == Form::kPoints ? skeleton_formats()
                                 : skeleton_file_formats();
}

// The skeleton's parameters, and what of it the surface leaves out.
std::string surface_params_text(const v1::SurfaceParams& surface) {
  const double least = surface.min_barrier();
  return skeleton_params_text(surface.skeleton()) +
         (least > 0 ? ", barriers from " + base::to_text(least) : "");
}

v1::FetchArtifactRequest surface_request(const FetchRequest& request, const ChosenSkeleton& chosen) {
  v1::FetchArtifactRequest asked = request_for(chosen.job, v1::ARTIFACT_KIND_SURFACE);
  v1::SurfaceParams& surface = *asked.mutable_surface();
  *surface.mutable_skeleton() = chosen.params;
  surface.set_alpha(request.alpha);
  surface.set_barrier(request.barrier || request.min_barrier > 0);
  surface.set_min_barrier(request.min_barrier);
  return asked;
}

// A sheet comes with its quality, an alpha shape does not.
Notice empty_surface(const v1::SkeletonQuality* quality) {
  Notice empty = warning("EMPTY_SURFACE", "the surface is empty: ");
  if (quality == nullptr) {
    empty.message +=
        "there are no three skeleton points near enough to each other; try a smaller threshold or a larger alpha";
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

// What a file has that holds nothing else of a skeleton.
void count_points(std::size_t vertices, Fetched& fetched) {
  fetched.unit = "point";
  fetched.items = vertices;
}

Fetched fetch_complex(Session& session, const FetchRequest& request, const ChosenSkeleton& chosen,
                      ShapeOutput& output) {
  const v1::FetchArtifactRequest asked = surface_request(request, chosen);
  v1::ArtifactHeader header;
  const FetchedSurface surface = parse_surface(fetch_patiently(session, asked, header, "skeleton"));
  const bool sheet = wire::gives_sheet(chosen.params.operator_());
  const v1::SkeletonQuality* quality = sheet ? &surface.quality : nullptr;
  require_place_for_curves(surface.shape, output.format(), request.destination);
  output.write(write_surface, surface.shape, header.job(),
               {sheet ? "affine skeleton" : "affine skeleton, the alpha shape of its points", "operator",
                surface_params_text(asked.surface()), quality});
  Fetched fetched{request.destination, request.artifact, "triangle", surface.shape.mesh().triangles.size(),
                  header.job()};
  const std::size_t vertices = surface.shape.mesh().points.size();
  const bool alone = fetched.items == 0 && surface.shape.segments.empty();
  if (alone && vertices > 0 && output.format() != FileFormat::kStl) count_points(vertices, fetched);
  fetched.notices = lost_curves(surface.shape, output.format(), request.destination.name());
  fetched.segments = holds_curves(output.format()) ? surface.shape.segments.size() : 0;
  if (quality != nullptr) fetched.quality = *quality;
  if (vertices == 0)
    fetched.notices.push_back(empty_surface(quality));
  else if (quality != nullptr)
    append(fetched.notices, skeleton_notices(vertices, *quality, header.job()));
  return fetched;
}

Fetched fetch_points(Session& session, const FetchRequest& request, const ChosenSkeleton& chosen,
                     ShapeOutput& output) {
  v1::FetchArtifactRequest asked = request_for(chosen.job, v1::ARTIFACT_KIND_SKELETON);
  *asked.mutable_skeleton() = chosen.params;
  v1::ArtifactHeader header;
  const v1::SkeletonPoints points = parse_skeleton(fetch_patiently(session, asked, header, "skeleton"));
  const v1::SkeletonQuality* quality = points.has_quality() ? &points.quality() : nullptr;
  output.write(write_points, shape_of(points), header.job(),
               {"affine skeleton", "operator", skeleton_params_text(chosen.params), quality});
  Fetched fetched{request.destination, request.artifact, "point",
                  static_cast<std::uint64_t>(points.point_size()), header.job()};
  fetched.notices = skeleton_notices(fetched.items, points.quality(), header.job());
  if (quality != nullptr) fetched.quality = *quality;
  return fetched;
}

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

// The job's own curve where the choice leaves it open; what is chosen for another operator is not for this one.
ChosenSkeleton choose_curve(Session& session, const FetchRequest& request) {
  ChosenSkeleton curve{request.job, {}};
  curve.params.set_operator_(v1::OPERATOR_CURVE);
  const std::string& named = request.skeleton.operator_name;
  if (request.skeleton.threshold == 0 && named.empty()) {
    const v1::Job job = session.get_job(request.job);
    if (job.skeleton().operator_() == v1::OPERATOR_CURVE) curve.params = job.skeleton();
    curve.job = job.id();
  } else if (named.empty() || named == operator_word(v1::OPERATOR_CURVE)) {
    curve.params.set_threshold(request.skeleton.threshold);
  }
  return curve;
}

// The curve as joints, with the surface that they move.
Fetched fetch_armature(Session& session, const FetchRequest& request, const ChosenSkeleton& chosen,
                       ShapeOutput& output) {
  v1::ArtifactHeader header;
  const v1::SolidParts solid = fetch_solid_parts(session, chosen.job, chosen.params.threshold(), header);
  const LimbedSurface limbed = limbed_surface(solid);
  output.write_by([&](const std::vector<std::string>& comments,
                      const WriteBytes& write) { write_glb(limbed, comments, write); },
                  header.job(),
                  {"curve skeleton, as joints of the solid", "operator", skeleton_params_text(chosen.params),
                   &solid.curve().quality()});
  Fetched fetched{request.destination, "curve", "triangle", limbed.surface.triangles.size(), header.job()};
  fetched.quality = solid.curve().quality();
  fetched.notices = skeleton_notices(solid.curve(), header.job());
  return fetched;
}

}  // namespace

Fetched fetch_skeleton(Session& session, const FetchRequest& request) {
  if (wants_lines(session, request)) return fetch_curve(session, request);
  const bool barriers = request.barrier || request.min_barrier > 0;
  ShapeOutput output(request.destination, formats_of(form_of(request)),
                     barriers ? "skeleton with barriers" : "skeleton");
  const ChosenSkeleton chosen = choose_skeleton(session, request.job, request.skeleton);
  return wants_complex(request, chosen.params, output.format())
             ? fetch_complex(session, request, chosen, output)
             : fetch_points(session, request, chosen, output);
}

Fetched fetch_surface(Session& session, const FetchRequest& request) {
  FetchRequest complex = request;
  complex.form = Form::kSurface;
  return fetch_skeleton(session, complex);
}

Fetched fetch_curve(Session& session, const FetchRequest& request) {
  ShapeOutput output(request.destination, curve_file_formats(), "curve skeleton");
  const ChosenSkeleton chosen = choose_curve(session, request);
  if (output.format() == FileFormat::kGlb) return fetch_armature(session, request, chosen, output);
  v1::FetchArtifactRequest asked = request_for(chosen.job, v1::ARTIFACT_KIND_SURFACE);
  *asked.mutable_surface()->mutable_skeleton() = chosen.params;
  v1::ArtifactHeader header;
  const FetchedSurface curve = parse_surface(fetch_patiently(session, asked, header, "curve skeleton"));
  output.write(write_curve, curve.shape, header.job(),
               {"curve skeleton", "operator", skeleton_params_text(chosen.params), &curve.quality});
  Fetched fetched{request.destination, "curve", "segment", curve.shape.segments.size(), header.job()};
  const std::size_t vertices = curve.shape.mesh().points.size();
  if (fetched.items == 0 || output.format() == FileFormat::kCsv || output.format() == FileFormat::kXyz)
    count_points(vertices, fetched);
  fetched.quality = curve.quality;
  fetched.notices = skeleton_notices(vertices, curve.quality, header.job());
  if (output.format() == FileFormat::kSwc && curve.quality.holes() > 0)
    fetched.notices.push_back(
        warning("CUT_LOOPS", ".swc holds trees: " + base::counted(curve.quality.holes(), "loop") +
                                 " cut where " + (curve.quality.holes() == 1 ? "it closes" : "they close")));
  return fetched;
}

}  // namespace affskel::client
