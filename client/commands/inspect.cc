#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "base/number_text.h"
#include "client/commands/commands.h"
#include "client/files/read/input_file.h"
#include "client/files/read/mesh_defects.h"
#include "client/text/key_line.h"
#include "core/solid/solid.h"
#include "wire/sha256.h"

namespace affskel::client {
namespace {

using nlohmann::ordered_json;

ordered_json vec(const core::Vec3& v) {
  return {v.x, v.y, v.z};
}

std::string text_of(const ordered_json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
  if (value.is_number_float()) return base::to_text(value.get<double>());
  if (!value.is_array()) return value.dump();
  std::string text;
  for (const ordered_json& element : value) text += (text.empty() ? "" : " ") + text_of(element);
  return text;
}

ordered_json file_facts(const InputFile& input) {
  ordered_json facts = {{"file", input.path},
                        {"format", input.format},
                        {"bytes", input.file_bytes},
                        {"sha256", input.file_sha256}};
  if (input.converted()) {
    facts["submitted_bytes"] = input.bytes.size();
    facts["submitted_sha256"] = wire::sha256_hex(input.bytes);
  }
  facts["vertices"] = input.off.mesh.points.size();
  facts["polygons"] = input.off.polygons;
  facts["polygons_cut"] = input.off.polygons_cut;
  facts["triangles"] = input.off.mesh.triangles.size();
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

ordered_json notes_json(const core::Solid& solid) {
  ordered_json notes = ordered_json::array();
  for (const core::MeshNote& note : solid.notes) {
    const bool repaired = note.severity == core::MeshNote::Severity::kRepaired;
    notes.push_back(
        {{"severity", repaired ? "repaired" : "warning"}, {"code", note.code}, {"message", note.message}});
  }
  return notes;
}

ordered_json defects_json(const std::vector<MeshDefect>& defects) {
  ordered_json list = ordered_json::array();
  for (const MeshDefect& defect : defects) {
    list.push_back({{"code", defect.code},
                    {"count", defect.count},
                    {"message", defect.message},
                    {"lines", defect.lines}});
  }
  return list;
}

std::string facts_text(const ordered_json& facts) {
  std::string text;
  for (const auto& [key, value] : facts.items()) {
    if (key == "surfaces") {
      if (value.size() < 2) continue;
      for (const ordered_json& s : value) {
        text += key_line("surface", std::string(s["cavity"].get<bool>() ? "cavity of" : "outside of") +
                                        " solid " + s["solid"].dump() + ", " + s["triangles"].dump() +
                                        " triangles, genus " + s["genus"].dump() + ", volume " +
                                        text_of(s["volume"]));
      }
    } else if (key == "notes" || key == "defects") {
      for (const ordered_json& entry : value) {
        const std::string what = key == "defects" ? "defect" : entry["severity"].get<std::string>();
        text += key_line(what, entry["code"].get<std::string>() + ": " + entry["message"].get<std::string>());
      }
    } else {
      text += key_line(key, text_of(value));
    }
  }
  return text;
}

void show(Console& console, const ordered_json& facts) {
  console.result(facts_text(facts));
  console.document(facts);
}

void run(Console& console, const std::string& file) {
  const InputFile input = read_input(file);
  ordered_json facts = file_facts(input);
  try {
    const core::Solid solid = check_solid(input, true);
    add_solid_facts(facts, solid);
    facts["computable"] = true;
    facts["notes"] = notes_json(solid);
    show(console, facts);
  } catch (const ClientError&) {
    facts["computable"] = false;
    facts["defects"] = defects_json(find_defects(input.off));
    show(console, facts);
    throw;
  }
}

}  // namespace

void add_inspect(CommandLine& line) {
  const auto file = std::make_shared<std::string>();
  CLI::App* command = line.add("inspect", "What a mesh is, and every defect with its place; needs no server",
                               "  affskel-client inspect body.off\n  affskel-client --json inspect scan.stl",
                               [file](Context& context) { run(context.console(), *file); });
  command->add_option("FILE", *file, "Geomview OFF text, .ply, .obj, .stl or .vtp")
      ->required()
      ->type_name("");
}

}  // namespace affskel::client
