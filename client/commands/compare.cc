#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "client/cli/number_parsers.h"
#include "client/cli/value_checks.h"
#include "client/commands/commands.h"
#include "client/commands/shared/destination.h"
#include "client/commands/shared/notices.h"
#include "client/commands/shared/shape_options.h"
#include "client/files/read/input_file.h"
#include "client/files/read/read_shape.h"
#include "client/operations/compare.h"

namespace affskel::client {
namespace {

struct CompareOptions {
  CompareRequest request;
  std::string radii;  // comma-separated
};

CompareRequest request_of(const CompareOptions& options) {
  CompareRequest request = options.request;
  const ComparisonOptions& files = request.comparison;
  if ((files.a == "-") + (files.b == "-") + (files.solid == "-") > 1)
    throw ClientError(ExitCode::kUsage, "only one of A, B and --solid can be standard input");
  if (options.radii.empty()) return request;
  const std::optional<std::vector<double>> radii = parse_numbers(options.radii);
  if (!radii)
    throw ClientError(ExitCode::kUsage,
                      "--radii: expected numbers separated by commas, not '" + options.radii + "'");
  request.comparison.radii = *radii;
  return request;
}

// Each file's work within its budget.
FileWork work_within(const Context& context) {
  const auto read = [&context](const std::string& path) {
    return context.within_budget(Budget::Work::kReading, path, [&] { return read_shape(path); });
  };
  const auto make_solid = [&context](const InputFile& input) {
    return context.within_budget(Budget::Work::kRepair, input.path, [&] { return check_solid(input, true); });
  };
  return {read, make_solid};
}

// Whether one of the files is standard output, where nothing else may be then.
bool fills_standard_output(const CompareRequest& request, const Console& console) {
  const bool plot = destination_of(request.plot, "", console).is_stdout();
  const bool table = destination_of(request.table, "", console).is_stdout();
  if (plot && table) throw ClientError(ExitCode::kUsage, "--plot - and -o - both want standard output");
  return plot || table;
}

void run_compare(Context& context, const CompareOptions& options) {
  Console& console = context.console();
  const CompareRequest request = request_of(options);
  const bool filled = fills_standard_output(request, console);
  const Comparison comparison = compare(request, work_within(context));
  say(console, comparison.notices);
  nlohmann::ordered_json document = comparison_json(comparison);
  const auto show_file = [&](const char* key, const std::string& file) {
    if (file.empty()) return;
    console.note("wrote " + Destination{file}.name());
    document[key] = file;
  };
  show_file("plot", request.plot);
  show_file("csv", request.table);
  const std::string text = comparison_text(comparison);
  if (filled) {
    console.note(text.substr(0, text.size() - 1));
  } else {
    console.result(text);
  }
  console.document(document);
}

}  // namespace

void add_compare(CommandLine& line) {
  const auto options = std::make_shared<CompareOptions>();
  ComparisonOptions& o = options->request.comparison;
  CLI::App* command = line.add(
      "compare", "Similarity of two skeleton files; needs no server",
      "  affskel-client compare a.ply b.ply --plot curve.svg\n"
      "  affskel-client compare a.ply b.ply --solid body.off -o curve.csv\n"
      "  affskel-client compare a.csv b.csv --squared --radii 1.2e5,1e6,1e7,1e8\n"
      "The table tells the share of A's points within r of B and back; its area under the curve is taken up\n"
      "to the largest r and divided by it. Points: .csv .ply .off .xyz .vtp .dat; surfaces: .off .ply .obj\n"
      ".stl .vtp, compared by points spread evenly over them.",
      [options](Context& context) { run_compare(context, *options); });
  add_file(command, "A", o.a, "Skeleton: points or a surface. - reads it from stdin");
  add_file(command, "B", o.b, "The other one, or -");
  command
      ->add_option("--radius", o.radius,
                   "Radius that matters (default: sqrt(3)/128 of the longest side of the solid's\n"
                   "box, or of the skeletons' without --solid)")
      ->check(positive_number())
      ->type_name("R");
  command
      ->add_option("--radii", options->radii,
                   "Radii of the table, comma-separated (default: 0 to 4 R in 16 steps)")
      ->check(non_empty())
      ->type_name("LIST");
  command->add_flag("--squared", o.squared, "Radii are given and shown squared, as in the published work");
  command
      ->add_option("--solid", o.solid,
                   "Mesh of the solid: adds the chance level, the share of its inside within r")
      ->check(non_empty())
      ->type_name("FILE");
  command->add_option("--samples", o.samples, "Points to spread over each surface")
      ->check(whole_number(1, 10000000))
      ->capture_default_str()
      ->type_name("N");
  command->add_option("--plot", options->request.plot, "Write the curves as a plot (.svg), or -")
      ->check(non_empty())
      ->type_name("FILE");
  command->add_option("-o,--output,--csv", options->request.table, "Write the table (.csv), or -")
      ->check(non_empty())
      ->type_name("FILE");
}

}  // namespace affskel::client
