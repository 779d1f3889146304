#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "base/number_text.h"
#include "client/commands/commands.h"
#include "client/commands/shared/inspection.h"
#include "client/files/read/input_file.h"
#include "client/text/key_line.h"

namespace affskel::client {
namespace {

using nlohmann::ordered_json;

std::string text_of(const ordered_json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
  if (value.is_number_float()) return base::to_text(value.get<double>());
  if (!value.is_array()) return value.dump();
  std::string text;
  for (const ordered_json& element : value) text += (text.empty() ? "" : " ") + text_of(element);
  return text;
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
  const Inspection inspection = inspect(read_input(file));
  show(console, inspection.facts);
  if (inspection.error) throw *inspection.error;
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
