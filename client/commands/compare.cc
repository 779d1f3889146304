#include <functional>
#include <nlohmann/json.hpp>
#include <optional>

#include "client/commands/commands.h"
#include "client/comparison/comparison.h"
#include "client/files/format.h"
#include "client/files/write/atomic_file.h"

namespace affskel::client {
namespace {

// Opened at once, so that a place which cannot be written is known before the work is done.
std::optional<AtomicFile> opened(const std::string& path) {
  return path.empty() ? std::nullopt : std::optional<AtomicFile>(std::in_place, path);
}

void fill(std::optional<AtomicFile>& file, const std::function<std::string()>& text) {
  if (!file) return;
  file->write(text());
  file->sync();
}

void appear(std::optional<AtomicFile>& file, const std::string& path, Console& console) {
  if (!file) return;
  file->commit();
  console.note("wrote " + path);
}

}  // namespace

void run_compare(Console& console, const CompareOptions& options) {
  // Wrong extensions are known before the work is done.
  constexpr FileFormat kPlot[] = {FileFormat::kSvg}, kTable[] = {FileFormat::kCsv};
  if (!options.plot.empty()) choose_format(options.plot, kPlot, "plot");
  if (!options.output.empty()) choose_format(options.output, kTable, "table");
  std::optional<AtomicFile> plot = opened(options.plot), table = opened(options.output);
  const Comparison comparison = compare_files(options, console);
  nlohmann::ordered_json document = comparison_json(comparison);
  // Both are complete on the disk before either appears.
  fill(plot, [&] { return svg_of(comparison_plot(comparison)); });
  fill(table, [&] { return comparison_csv(comparison); });
  appear(plot, options.plot, console);
  appear(table, options.output, console);
  if (plot) document["plot"] = options.plot;
  if (table) document["csv"] = options.output;
  console.result(comparison_text(comparison));
  console.document(document);
}

}  // namespace affskel::client
