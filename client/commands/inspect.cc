#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <vector>

#include "base/atomic_file.h"
#include "base/number_text.h"
#include "client/cli/value_checks.h"
#include "client/commands/commands.h"
#include "client/commands/shared/destination.h"
#include "client/commands/shared/shape_options.h"
#include "client/files/read/input_file.h"
#include "client/operations/inspection.h"
#include "client/operations/mesh_picture.h"
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

std::string measure_text(const ordered_json& measure) {
  return base::plain(measure.get<double>(), base::kMeasureDigits);
}

std::string box_text(const std::vector<double>& place, const std::vector<double>& size) {
  return place_in_box(place, *std::max_element(size.begin(), size.end()));
}

// Each place a line of its own.
std::string all_places(const ordered_json& defect) {
  std::string text = key_line("defect", defect["code"].get<std::string>() + ": " + defect["count"].dump() +
                                            " " + defect["cause"].get<std::string>());
  for (const ordered_json& place : defect["places"]) text += key_line("place", place["where"]);
  return text;
}

std::string few_places(const ordered_json& defect) {
  const bool more = defect["count"].get<std::uint64_t>() > defect["places"].size();
  return key_line("defect", defect["code"].get<std::string>() + ": " + defect["message"].get<std::string>() +
                                (more ? " (--all)" : ""));
}

std::string holes_text(const ordered_json& holes) {
  std::string text = key_line("holes", holes["count"].dump());
  for (const ordered_json& hole : holes["longest"]) {
    const ordered_json& c = hole["centre"];
    text += key_line(
        "hole", base::rounded(hole["length"].get<double>(), 4) + " round, " + hole["edges"].dump() +
                    " edges, near (" + base::rounded(c[0].get<double>(), 4) + ", " +
                    base::rounded(c[1].get<double>(), 4) + ", " + base::rounded(c[2].get<double>(), 4) + ")");
  }
  return text;
}

std::string facts_text(const ordered_json& facts, bool all) {
  std::string text;
  for (const auto& [key, value] : facts.items()) {
    if (key == "surfaces") {
      if (value.size() < 2) continue;
      for (const ordered_json& s : value) {
        text += key_line("surface", std::string(s["cavity"].get<bool>() ? "cavity of" : "outside of") +
                                        " solid " + s["solid"].dump() + ", " + s["triangles"].dump() +
                                        " triangles, genus " + s["genus"].dump() + ", volume " +
                                        measure_text(s["volume"]));
      }
    } else if (key == "notes") {
      for (const ordered_json& entry : value) {
        text += key_line(entry["severity"],
                         entry["code"].get<std::string>() + ": " + entry["message"].get<std::string>());
      }
    } else if (key == "defects") {
      for (const ordered_json& entry : value) text += all ? all_places(entry) : few_places(entry);
    } else if (key == "holes") {
      text += holes_text(value);
    } else if (key == "passed_over") {
      for (const ordered_json& rows : value) {
        const bool has_lines = rows["first_line"].get<std::uint64_t>() > 0;  // of text
        text +=
            key_line("passed_over", rows["rows"].dump() + " of " + rows["word"].get<std::string>() +
                                        (has_lines ? ", first in line " + rows["first_line"].dump() : ""));
      }
    } else if (key == "volume") {
      text += key_line(key, measure_text(value));
    } else if (key.starts_with("bbox_")) {
      text += key_line(key, box_text(value, facts["bbox_size"]));
    } else {
      text += key_line(key, text_of(value));
    }
  }
  return text;
}

struct InspectOptions {
  std::string file;
  std::string picture;  // file, or empty
  bool all = false;
  core::MeshFileOptions reading;
};

void draw(Console& console, const InspectOptions& options, const InputFile& input) {
  const Destination destination = destination_of(options.picture, "", console);
  choose_format(destination, picture_formats(), "picture");
  base::AtomicFile file(destination.file);
  file.write(mesh_picture(input, std::filesystem::path(input.path).filename().string(), {}));
  file.commit();
  console.note("wrote " + destination.name());
}

void run_inspect(Context& context, const InspectOptions& options) {
  Console& console = context.console();
  const std::size_t places = options.all ? std::numeric_limits<std::size_t>::max() : kFewPlaces;
  const InputFile input = context.within_budget(
      Budget::Work::kReading, options.file, [&] { return read_named_input(options.file, options.reading); });
  const Inspection inspection =
      context.within_budget(Budget::Work::kRepair, options.file, [&] { return inspect(input, places); });
  if (!options.picture.empty()) draw(console, options, input);
  console.result(facts_text(inspection.facts, options.all));
  console.document(inspection.facts);
  if (inspection.error) throw *inspection.error;
}

}  // namespace

void add_inspect(CommandLine& line) {
  const auto options = std::make_shared<InspectOptions>();
  CLI::App* command = line.add("inspect", "What a mesh is, and every defect with its place; needs no server",
                               "  affskel-client inspect body.off\n  affskel-client inspect scan.off --all\n"
                               "  affskel-client --json inspect scan.stl\n"
                               "  affskel-client inspect scan.off --render defects.png",
                               [options](Context& context) { run_inspect(context, *options); });
  command->add_option("FILE", options->file, mesh_kinds() + "; - reads it from stdin")
      ->required()
      ->check(mesh_file())
      ->type_name("");
  command
      ->add_option("--render", options->picture,
                   "PNG file to write: the mesh from the front, the side and above, its defects\nmarked")
      ->type_name("FILE");
  add_isovalue(command, options->reading.isovalue);
  command->add_flag("--all", options->all,
                    "Every place of every defect, each on a line; else the first five");
}

}  // namespace affskel::client
