#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "client/cli/number_parsers.h"
#include "client/cli/value_checks.h"
#include "client/commands/commands.h"
#include "client/commands/shared/notices.h"
#include "client/commands/shared/shape_options.h"
#include "client/operations/compare.h"

namespace affskel::client {
namespace {

struct CompareOptions {
  CompareRequest request;
  std::string radii;  // comma-separated
};

CompareRequest request_of(const CompareOptions& options) {
  CompareRequest request = options.request;
  if (options.radii.empty()) return request;
  const std::optional<std::vector<double>> radii = parse_numbers(options.radii);
  if (!radii)
    throw ClientError(ExitCode::kUsage,
                      "--radii: expected numbers separated by commas, not '" + options.radii + "'");
  request.comparison.radii = *radii;
  return request;
}

void run_compare(Console& console, const CompareOptions& options) {
  const CompareRequest request = request_of(options);
  const Comparison comparison = compare(request);
  say(console, comparison.notices);
  nlohmann::ordered_json document = comparison_json(comparison);
  const auto show_file = [&](const char* key, const std::string& file) {
    if (file.empty()) return;
    console.note("wrote " + file);
    document[key] = file;
  };
  show_file("plot", request.plot);
  show_file("csv", request.table);
  console.result(comparison_text(comparison));
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
      [options](Context& context) { run_compare(context.console(), *options); });
  add_file(command, "A", o.a, "Skeleton: points or a surface");
  add_file(command, "B", o.b, "The other one");
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
  command->add_option("--plot", options->request.plot, "Write the curves as a plot (.svg)")
      ->check(non_empty())
      ->type_name("FILE");
  command->add_option("-o,--output,--csv", options->request.table, "Write the table (.csv)")
      ->check(non_empty())
      ->type_name("FILE");
}

}  // namespace affskel::client
