#include "client/operations/mesh_picture.h"

#include <array>

#include "base/number_text.h"
#include "client/base/stance.h"
#include "client/files/read/mesh_defects.h"
#include "client/view/page.h"
#include "core/mesh/box.h"

namespace affskel::client {
namespace {

constexpr std::size_t kMaxMarked = 100'000, kMaxOnPage = 20'000;  // of a kind
constexpr double kPerTube = 150;  // lengths of a mesh per step of what is drawn round its defects
constexpr std::array<Rgb, 4> kColours = {
    {{0.86f, 0.10f, 0.12f}, {0.55f, 0.20f, 0.75f}, {0.90f, 0.50f, 0.05f}, {0.05f, 0.55f, 0.45f}}};

DefectMarks marks_of(const MeshDefect& defect, Rgb colour) {
  DefectMarks marks{{colour, base::counted(defect.count, defect.name)}, {}};
  for (const DefectPlace& place : defect.places)
    marks.edges.insert(marks.edges.end(), place.edges.begin(), place.edges.end());
  return marks;
}

// The ends of all marked edges; the sheet has no triangles.
v1::TriangleMesh lines_of(const core::Mesh& mesh, const std::vector<MeshDefect>& defects) {
  v1::TriangleMesh lines;
  for (const MeshDefect& defect : defects) {
    for (const DefectPlace& place : defect.places) {
      for (const core::Segment& edge : place.edges) {
        for (const std::uint32_t v : edge) {
          lines.add_segments(static_cast<std::uint32_t>(lines.erosion_size()));
          for (const double c : {mesh.points[v].x, mesh.points[v].y, mesh.points[v].z}) lines.add_xyz(c);
          lines.add_erosion(0);
          lines.add_strength(1);
        }
      }
    }
  }
  return lines;
}

}  // namespace

std::string mesh_page(const InputFile& input, const std::string& name) {
  const std::vector<MeshDefect> defects = find_defects(input.off, kMaxOnPage);
  ViewModel model;
  model.mesh = input.off.mesh;
  model.job.set_name(name);
  model.job.mutable_prepared()->set_volume(1);
  for (const MeshDefect& defect : defects)
    model.job.mutable_prepared()->add_notes()->set_message(std::to_string(defect.count) + " " + defect.cause);
  model.sheet_is_skeleton = true;
  model.sheet = lines_of(model.mesh, defects);
  const double step = core::box_of(model.mesh).longest_side() / kPerTube;
  model.grid = {{}, {{{step, 0, 0}, {0, step, 0}, {0, 0, step}}}, {1, 1, 1}};
  ViewInput page;
  page.mesh_only = true;
  page.stance = core::find_stance(model.mesh);
  page.models.push_back(std::move(model));
  return view_page(page);
}

std::string mesh_picture(const InputFile& input, const std::string& name, const RenderOptions& look) {
  RenderInput scene;
  scene.mesh = input.off.mesh;
  scene.cell = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  scene.stance = core::find_stance(scene.mesh);
  scene.title = name + ": " + base::counted(scene.mesh.triangles.size(), "triangle");
  for (const MeshDefect& defect : find_defects(input.off, kMaxMarked))
    scene.marks.push_back(marks_of(defect, kColours[scene.marks.size() % kColours.size()]));
  return encode_png(render_scene(scene, look));
}

}  // namespace affskel::client
