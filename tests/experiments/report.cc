#include "report.h"

#include <algorithm>
#include <fstream>
#include <stdexcept>
#include <utility>

namespace affskel::experiments {
namespace {

std::string summary(const std::vector<Comparison>& comparisons) {
  std::string text = "| experiment | published (2003) | here | verdict |\n|---|---|---|---|\n";
  for (const Comparison& c : comparisons)
    text += tests::table_row({c.experiment, c.published, c.here, c.verdict});
  return text;
}

std::string check_table(const std::vector<Check>& checks) {
  Table table{{"figure", "value", "at least", "at most", "holds"}, {}};
  for (const Check& c : checks) {
    table.rows.push_back({c.what, format("%.6g", c.value), format("%g", c.low), format("%g", c.high),
                          c.holds() ? "yes" : "**no**"});
  }
  return table.markdown();
}

}  // namespace

Report::Report(std::filesystem::path directory) : directory_(std::move(directory)) {
  std::filesystem::create_directories(directory_);
}

void Report::section(std::string_view title) {
  body_.append("## ").append(title).append("\n\n");
}

void Report::subsection(std::string_view title) {
  body_.append("### ").append(title).append("\n\n");
}

void Report::text(std::string_view paragraph) {
  body_.append(paragraph).append("\n\n");
}

void Report::table(const Table& table) {
  body_ += table.markdown() + "\n";
}

void Report::picture(const std::string& name, const client::Image& image, std::string_view caption) {
  write_file(name + ".png", client::encode_png(image));
  body_.append("![").append(caption).append("](" + name + ".png)\n\n");
}

void Report::drawing(const std::string& name, std::string_view svg, std::string_view caption) {
  write_file(name + ".svg", svg);
  body_.append("![").append(caption).append("](" + name + ".svg)\n\n");
}

void Report::expect(std::string what, double value, double low, double high) {
  checks_.push_back({std::move(what), value, low, high});
}

bool Report::all_hold() const {
  return std::all_of(checks_.begin(), checks_.end(), [](const Check& c) { return c.holds(); });
}

void Report::write(std::string_view heading) const {
  std::string page(heading);
  page += "\n## Summary\n\n" + summary(comparisons_) + "\n" + body_ +
          "## Checks\n\nFigures of this report that must lie in a range; the command fails when one does "
          "not.\n\n" +
          check_table(checks_);
  write_file("REPORT.md", page);
}

void Report::write_file(const std::string& name, std::string_view bytes) const {
  const std::filesystem::path path = directory_ / name;
  std::ofstream file(path, std::ios::binary);
  file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (!file.flush()) throw std::runtime_error(path.string() + ": cannot be written");
}

}  // namespace affskel::experiments
