#include <CLI/CLI.hpp>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "base/atomic_file.h"
#include "client/cli/value_checks.h"
#include "client/commands/commands.h"
#include "client/commands/shared/shape_options.h"
#include "client/comparison/comparison.h"
#include "client/files/format.h"

namespace affskel::client {
namespace {

struct Options {
  ComparisonOptions comparison;
  std::string plot, output;  // SVG and CSV; empty = none
};

// Opened at once, so that a place which cannot be written is known before the work is done.
std::optional<base::AtomicFile> opened(const std::string& path) {
  return path.empty() ? std::nullopt : std::optional<base::AtomicFile>(std::in_place, path);
}

void fill(std::optional<base::AtomicFile>& file, const std::function<std::string()>& text) {
  if (!file) return;
  file->write(text());
  file->sync();
}

void appear(std::optional<base::AtomicFile>& file, const std::string& path, Console& console) {
  if (!file) return;
  file->commit();
  console.note("wrote " + path);
}

void run(Console& console, const Options& options) {
  // Refuse wrong extensions before the work is done.
  constexpr FileFormat kPlot[] = {FileFormat::kSvg}, kTable[] = {FileFormat::kCsv};
  if (!options.plot.empty()) choose_format(options.plot, kPlot, "plot");
  if (!options.output.empty()) choose_format(options.output, kTable, "table");
  std::optional<base::AtomicFile> plot = opened(options.plot), table = opened(options.output);
  const Comparison comparison = compare_files(options.comparison, console);
  nlohmann::ordered_json document = comparison_json(comparison);
  // Write both to the disk before either appears.
  fill(plot, [&] { return svg_of(comparison_plot(comparison)); });
  fill(table, [&] { return comparison_csv(comparison); });
  appear(plot, options.plot, console);
  appear(table, options.output, console);
  if (plot) document["plot"] = options.plot;
  if (table) document["csv"] = options.output;
  console.result(comparison_text(comparison));
  console.document(document);
}

}  // namespace

void add_compare(CommandLine& line) {
  const auto options = std::make_shared<Options>();
  ComparisonOptions& o = options->comparison;
  CLI::App* command = line.add(
      "compare", "Similarity of two skeleton files; needs no server",
      "  affskel-client compare a.ply b.ply --plot curve.svg\n"
      "  affskel-client compare a.ply b.ply --solid body.off -o curve.csv\n"
      "  affskel-client compare a.csv b.csv --squared --radii 1.2e5,1e6,1e7,1e8\n"
      "The table tells the share of A's points within r of B and back; its area under the curve is taken up\n"
      "to the largest r and divided by it. Points: .csv .ply .off .xyz .vtp .dat; surfaces: .off .ply .obj\n"
      ".stl .vtp, compared by points spread evenly over them.",
      [options](Context& context) { run(context.console(), *options); });
  add_file(command, "A", o.a, "Skeleton: points or a surface");
  add_file(command, "B", o.b, "The other one");
  command
      ->add_option("--radius", o.radius,
                   "Radius that matters (default: sqrt(3)/128 of the longest side of the solid's\n"
                   "box, or of the skeletons' without --solid)")
      ->check(positive_number())
      ->type_name("R");
  command
      ->add_option("--radii", o.radii, "Radii of the table, comma-separated (default: 0 to 4 R in 16 steps)")
      ->check(non_empty())
      ->type_name("LIST");
  command->add_flag("--squared", o.squared, "Radii are given and shown squared, as in the published work");
  command
      ->add_option("--solid", o.solid,
                   "Mesh of the solid: adds the chance level, the share of its inside within r")
      ->check(non_empty())
      ->type_name("FILE");
  command->add_option("--samples", o.samples, "Points to spread over each surface")
      ->check(whole_number(1, 100000000))
      ->capture_default_str()
      ->type_name("N");
  command->add_option("--plot", options->plot, "Write the curves as a plot (.svg)")
      ->check(non_empty())
      ->type_name("FILE");
  command->add_option("-o,--output,--csv", options->output, "Write the table (.csv)")
      ->check(non_empty())
      ->type_name("FILE");
}

}  // namespace affskel::client
