#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "client/render/image.h"
#include "tools/report_text.h"

namespace affskel::experiments {

using tests::count_of;
using tests::duration;
using tests::format;
using tests::Table;

/// A published figure beside ours, for the summary.
struct Comparison {
  std::string experiment;
  std::string published;
  std::string here;
  std::string verdict;  ///< whether they agree, and why not
};

/// A figure of the report that must lie in a range, so that a run that goes wrong does not go unseen.
struct Check {
  std::string what;
  double value = 0;
  double low = 0, high = 0;

  /// Not when the value is no number.
  bool holds() const { return value >= low && value <= high; }
};

/// The report while it grows: REPORT.md and the pictures it shows, all in one directory.
class Report {
 public:
  /// Makes the directory if there is none.
  explicit Report(std::filesystem::path directory);

  void section(std::string_view title);
  void subsection(std::string_view title);
  /// A paragraph of Markdown.
  void text(std::string_view paragraph);
  void table(const Table& table);
  /// Writes NAME.png at once and shows it. @param caption the alternative text, one line.
  void picture(const std::string& name, const client::Image& image, std::string_view caption);
  /// The same for NAME.svg.
  void drawing(const std::string& name, std::string_view svg, std::string_view caption);

  void compare(Comparison comparison) { comparisons_.push_back(std::move(comparison)); }
  /// Holds the value to low <= value <= high.
  void expect(std::string what, double value, double low, double high);

  const std::vector<Check>& checks() const { return checks_; }
  bool all_hold() const;

  /// Writes REPORT.md: the heading, the summary, the sections, the checks.
  /// @param heading Markdown that goes before the summary.
  void write(std::string_view heading) const;

 private:
  void write_file(const std::string& name, std::string_view bytes) const;

  std::filesystem::path directory_;
  std::string body_;
  std::vector<Comparison> comparisons_;
  std::vector<Check> checks_;
};

}  // namespace affskel::experiments
