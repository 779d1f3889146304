#include "client/operations/picture.h"

#include <algorithm>
#include <utility>

#include "base/number_text.h"
#include "client/artifacts/skeleton_points.h"
#include "client/artifacts/solid_parts.h"
#include "client/operations/artifact_calls.h"
#include "client/operations/job_notices.h"
#include "client/operations/kept_stance.h"
#include "client/render/scene.h"
#include "client/text/skeleton_text.h"
#include "client/text/words.h"
#include "wire/params.h"

namespace affskel::client {
namespace {

constexpr float kPartOpacity = 0.72f;  // the curve shines through
constexpr int kMaxRows = 24;           // of the legend

// The steps of the lattice, mesh units; a job of a server that told no frame has cubic cells.
std::array<core::Vec3, 3> lattice_cell(const v1::PreparedSummary& prepared) {
  std::array<core::Vec3, 3> cell = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  for (int a = 0; a < 3; ++a) {
    core::Vec3& axis = cell[static_cast<std::size_t>(a)];
    if (prepared.frame_size() == 9)
      axis = {prepared.frame(3 * a), prepared.frame(3 * a + 1), prepared.frame(3 * a + 2)};
    axis = prepared.spacing() * axis;
  }
  return cell;
}

std::string sheet_text(const v1::TriangleMesh& sheet) {
  const std::string curves = base::counted(sheet.segments_size() / 2, "segment") + " of curves";
  if (sheet.corners().empty() && !sheet.segments().empty()) return curves;
  if (sheet.corners().empty() && !sheet.xyz().empty()) return base::counted(sheet.xyz_size() / 3, "point");
  const std::string triangles = "sheet of " + base::counted(sheet.corners_size() / 3, "triangle");
  return sheet.segments().empty() ? triangles : triangles + " and " + curves;
}

// The skeleton, and by which parameters.
std::string shown_text(const RenderInput& input, const v1::SkeletonParams& params) {
  const std::string skeleton = wire::gives_sheet(params.operator_())
                                   ? sheet_text(input.sheet)
                                   : base::counted(input.skeleton.point_size(), "skeleton point");
  return skeleton + " (" + skeleton_params_text(params) + ")";
}

std::string title_of(const RenderInput& input, const v1::Job& job, const std::string& shown) {
  return job.name() + ": " + std::to_string(input.mesh.triangles.size()) + " triangles, " +
         base::counted(job.prepared().points(), "sample point") + " at spacing " +
         base::rounded(job.prepared().spacing(), 4) + ", " + shown;
}

v1::SkeletonPoints fetch_points(Session& session, const v1::Job& job, const v1::SkeletonParams& params) {
  v1::FetchArtifactRequest request = request_for(job.id(), v1::ARTIFACT_KIND_SKELETON);
  *request.mutable_skeleton() = params;
  v1::ArtifactHeader header;
  return parse_skeleton(fetch_patiently(session, request, header, "skeleton"));
}

// The skeleton as its operator gives it: points, or the sheet of chords.
// Returns the threshold that was applied, 0 when the server does not say.
double fetch_skeleton(Session& session, const v1::Job& job, const v1::SkeletonParams& params,
                      RenderInput& input, Notices& notices) {
  const bool sheet = wire::gives_sheet(params.operator_());
  if (sheet) {
    input.sheet = fetch_sheet(session, job.id(), params);
  } else {
    input.skeleton = fetch_points(session, job, params);
  }
  const v1::SkeletonQuality& quality = sheet ? input.sheet.quality() : input.skeleton.quality();
  notices = sheet ? skeleton_notices(input.sheet, job)
                  : skeleton_notices(static_cast<std::uint64_t>(input.skeleton.point_size()), quality, job);
  return quality.threshold();
}

Notices fetch_eroded(Session& session, const v1::Job& job, double level, RenderInput& input) {
  input.eroded = fetch_eroded_surface(session, job.id(), level);
  input.level = "eroded solid, E >= " + base::rounded(100 * level, 4) + " % of v0";
  return eroded_notices(input.eroded);
}

PaintedBody by_part(const v1::SolidParts& solid) {
  PaintedBody body;
  body.mesh = surface_of(solid);
  body.opacity = kPartOpacity;
  const std::vector<Rgb> colours = colours_of(solid);
  for (const std::uint32_t part : solid.triangle_part()) body.colours.push_back(colours[part - 1]);
  for (int p = 0; p < solid.parts_size(); ++p) {
    const auto& along = solid.parts(p).vertices();
    const int middle = static_cast<int>(along[along.size() / 2]);
    const auto& xyz = solid.curve().xyz();
    body.labels.push_back({{xyz[3 * middle], xyz[3 * middle + 1], xyz[3 * middle + 2]},
                           std::to_string(p + 1),
                           colours[static_cast<std::size_t>(p)]});
  }
  body.title = "Parts, % of the volume";
  const int shown = std::min(solid.parts_size(), kMaxRows);
  for (int p = 0; p < shown; ++p) {
    body.rows.push_back({colours[static_cast<std::size_t>(p)],
                         std::to_string(p + 1) + " " + part_kind_word(solid.parts(p).kind()) + "  " +
                             base::rounded(100 * solid.parts(p).volume_share(), 3)});
  }
  if (shown < solid.parts_size())
    body.title += ", " + std::to_string(shown) + " of " + std::to_string(solid.parts_size());
  return body;
}

PaintedBody by_thickness(const v1::SolidParts& solid) {
  PaintedBody body;
  body.mesh = surface_of(solid);
  const auto [highest, greatest] = thickness_scale(
      body.mesh, {solid.thickness().data(), static_cast<std::size_t>(solid.thickness_size())});
  for (const double thickness : solid.thickness())
    body.colours.push_back(viridis(static_cast<float>(thickness / highest)));
  body.scale = {"Thickness, mesh units", "From the surface to the skeleton", highest, false,
                greatest > highest};
  return body;
}

// @returns what is shown, in words.
std::string paint(Session& session, const v1::Job& job, PictureColour colour, RenderInput& input,
                  Notices& notices) {
  v1::ArtifactHeader header;
  const v1::SolidParts solid = fetch_solid_parts(session, job.id(), 0, header);
  notices = skeleton_notices(solid.curve(), job);
  if (colour == PictureColour::kPart) {
    input.painted = by_part(solid);
    input.sheet = solid.curve();
    return base::counted(static_cast<std::uint64_t>(solid.parts_size()), "part");
  }
  input.painted = by_thickness(solid);
  return "thickness";
}

}  // namespace

Picture make_picture(Session& session, const v1::Job& job, const PictureOptions& options) {
  v1::SkeletonParams params = skeleton_params(options.skeleton, job);
  RenderInput input;
  Notices notices;
  std::string shown;
  if (options.colour == PictureColour::kErosion) {
    const double applied = fetch_skeleton(session, job, params, input, notices);
    if (params.threshold() == 0) params.set_threshold(applied);  // the default, for the title
    shown = shown_text(input, params);
  } else {
    shown = paint(session, job, options.colour, input, notices);
  }
  if (options.level > 0) append(notices, fetch_eroded(session, job, options.level, input));
  input.mesh = fetch_mesh(session, job.id());
  input.stance = keep_stance(session, job, options.stance, input.mesh);
  input.cell = lattice_cell(job.prepared());
  input.volume = job.prepared().volume();
  input.title = title_of(input, job, shown);
  return {encode_png(render_scene(input, options.render)), shown, std::move(notices)};
}

}  // namespace affskel::client
