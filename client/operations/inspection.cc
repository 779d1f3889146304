#include "client/operations/inspection.h"

#include "core/base/error.h"
#include "core/repair/fill_holes.h"
#include "core/repair/flat_sheet.h"
#include "wire/sha256.h"

namespace affskel::client {
namespace {

using nlohmann::ordered_json;

ordered_json vec(const core::Vec3& v) {
  return {v.x, v.y, v.z};
}

ordered_json file_facts(const InputFile& input) {
  ordered_json facts = {{"file", input.path},
                        {"format", input.format},
                        {"bytes", input.file_bytes},
                        {"sha256", input.file_sha256}};
  if (input.converted()) {
    const OffText text(input);
    facts["submitted_bytes"] = text.view().size();
    facts["submitted_sha256"] = wire::sha256_hex(text.view());
  }
  if (!input.off.unit.empty()) facts["unit"] = input.off.unit;
  facts["vertices"] = input.off.mesh.points.size();
  facts["polygons"] = input.off.polygons;
  facts["polygons_cut"] = input.off.polygons_cut;
  facts["triangles"] = input.off.mesh.triangles.size();
  if (!input.off.passed_over.empty()) {
    ordered_json rows = ordered_json::array();
    for (const core::PassedOver& one : input.off.passed_over)
      rows.push_back({{"word", one.word}, {"rows", one.rows}, {"first_line", one.first_line}});
    facts["passed_over"] = std::move(rows);
  }
  return facts;
}

void add_solid_facts(ordered_json& facts, const core::Solid& solid) {
  std::uint64_t cavities = 0;
  std::int64_t genus = 0;
  ordered_json surfaces = ordered_json::array();
  for (const core::Shell& shell : solid.shells) {
    cavities += shell.cavity ? 1 : 0;
    genus += shell.genus;
    surfaces.push_back({{"triangles", shell.triangles},
                        {"vertices", shell.vertices},
                        {"genus", shell.genus},
                        {"volume", shell.volume},
                        {"solid", shell.solid},
                        {"cavity", shell.cavity}});
  }
  facts["components"] = solid.shells.size();
  facts["solids"] = solid.solid_volume.size();
  facts["cavities"] = cavities;
  facts["genus"] = genus;
  facts["volume"] = solid.volume;
  facts["bbox_min"] = vec(solid.bbox_min);
  facts["bbox_max"] = vec(solid.bbox_max);
  facts["bbox_size"] = vec(solid.bbox_max - solid.bbox_min);
  facts["self_intersecting"] = solid.self_intersecting;
  facts["surfaces"] = surfaces;
}

ordered_json notes_json(const core::Solid& solid, const core::OffMesh& off) {
  ordered_json notes = ordered_json::array();
  if (const std::string text = uneven_text(off, solid.volume); !text.empty())
    notes.push_back({{"severity", "warning"}, {"code", "uneven-polygons"}, {"message", text}});
  for (const core::MeshNote& note : solid.notes) {
    notes.push_back(
        {{"severity", core::severity_word(note.severity)}, {"code", note.code}, {"message", note.message}});
  }
  return notes;
}

ordered_json defects_json(const std::vector<MeshDefect>& defects) {
  ordered_json list = ordered_json::array();
  for (const MeshDefect& defect : defects) {
    ordered_json places = ordered_json::array();
    for (const DefectPlace& place : defect.places) {
      places.push_back({{"line", place.line > 0 ? ordered_json(place.line) : ordered_json(nullptr)},
                        {"triangle", place.triangle},
                        {"where", place_text(place)}});
    }
    list.push_back({{"code", defect.code},
                    {"count", defect.count},
                    {"cause", defect.cause},
                    {"message", defect_text(defect)},
                    {"places", std::move(places)}});
  }
  return list;
}

// The longest ones.
ordered_json holes_json(const core::Mesh& mesh, std::size_t max_places) {
  std::vector<core::Hole> holes;
  try {
    holes = core::find_holes(mesh);
  } catch (const core::CoreError&) {  // there is no triangle: told by the defects
  }
  ordered_json list = ordered_json::array();
  for (const core::Hole& hole : holes) {
    if (list.size() == max_places) break;
    list.push_back({{"edges", hole.edges}, {"length", hole.length}, {"centre", vec(hole.centre)}});
  }
  return {{"count", holes.size()}, {"longest", std::move(list)}};
}

}  // namespace

Inspection inspect(const InputFile& input, std::size_t max_places, core::ExecutionContext* context) {
  Inspection inspection;
  inspection.facts = file_facts(input);
  try {
    inspection.solid = check_solid(input, true, context);
    add_solid_facts(inspection.facts, *inspection.solid);
    inspection.facts["computable"] = true;
    inspection.facts["notes"] = notes_json(*inspection.solid, input.off);
  } catch (const ClientError& error) {
    if (error.exit_code() == ExitCode::kCancelled) throw;
    inspection.facts["computable"] = false;
    inspection.facts["defects"] = defects_json(find_defects(input.off, max_places));
    inspection.facts["holes"] = holes_json(input.off.mesh, max_places);
    if (core::is_flat_sheet(input.off.mesh)) inspection.facts["flat"] = true;
    inspection.error = error;
  }
  return inspection;
}

}  // namespace affskel::client
