#include <nlohmann/json.hpp>

#include "client/commands/commands.h"
#include "client/comparison.h"
#include "client/exporters/atomic_file.h"
#include "client/exporters/format.h"

namespace affskel::client {
namespace {

void write_file(const std::string& path, const std::string& text, Console& console) {
  AtomicFile file(path);
  file.write(text);
  file.commit();
  console.note("wrote " + path);
}

}  // namespace

void run_compare(Console& console, const CompareOptions& options) {
  // Wrong extensions are known before the work is done.
  constexpr FileFormat kPlot[] = {FileFormat::kSvg}, kTable[] = {FileFormat::kCsv};
  if (!options.plot.empty()) choose_format(options.plot, kPlot, "plot");
  if (!options.output.empty()) choose_format(options.output, kTable, "table");
  const Comparison comparison = compare_files(options, console);
  nlohmann::ordered_json document = comparison_json(comparison);
  if (!options.plot.empty()) {
    write_file(options.plot, svg_of(comparison_plot(comparison)), console);
    document["plot"] = options.plot;
  }
  if (!options.output.empty()) {
    write_file(options.output, comparison_csv(comparison), console);
    document["csv"] = options.output;
  }
  console.result(comparison_text(comparison));
  console.document(document);
}

}  // namespace affskel::client
