#include "client/operations/mesh_picture.h"

#include <array>

#include "base/number_text.h"
#include "client/base/stance.h"
#include "client/operations/marked_edges.h"

namespace affskel::client {
namespace {

constexpr std::size_t kMaxMarked = 100'000;  // of a kind
constexpr std::array<Rgb, 4> kColours = {
    {{0.86f, 0.10f, 0.12f}, {0.55f, 0.20f, 0.75f}, {0.90f, 0.50f, 0.05f}, {0.05f, 0.55f, 0.45f}}};

DefectMarks marks_of(const MeshDefect& defect, Rgb colour) {
  DefectMarks marks{{colour, base::counted(defect.count, defect.name)}, {}};
  for (const DefectPlace& place : defect.places)
    marks.edges.insert(marks.edges.end(), place.edges.begin(), place.edges.end());
  return marks;
}

}  // namespace

std::string mesh_page(const InputFile& input, const std::string& name) {
  const std::vector<MeshDefect> defects = find_defects(input.off, kMarkedOnPage);
  ViewModel model;
  model.mesh = input.off.mesh;
  model.job.set_name(name);
  model.job.mutable_prepared()->set_volume(1);
  for (const MeshDefect& defect : defects)
    model.job.mutable_prepared()->add_notes()->set_message(std::to_string(defect.count) + " " + defect.cause);
  model.sheet_is_skeleton = true;
  model.grid = {{}, {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, {1, 1, 1}};
  model.marks = marked_edges(model.mesh, defects);
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
