#include "client/operations/compare.h"

#include <array>
#include <optional>

#include "base/atomic_file.h"
#include "client/files/format.h"

namespace affskel::client {
namespace {

// A file that appears once the others can.
class Pending {
 public:
  Pending(const std::string& path, FileFormat format, const char* what) {
    if (path.empty()) return;
    choose_format(Destination{path}, std::array{format}, what);
    file_.emplace(path);
  }
  explicit operator bool() const { return file_.has_value(); }
  void fill(const std::string& text) {
    file_->write(text);
    file_->sync();
  }
  void appear() { file_->commit(); }

 private:
  std::optional<base::AtomicFile> file_;
};

}  // namespace

Comparison compare(const CompareRequest& request, const FileWork& work) {
  Pending plot(request.plot, FileFormat::kSvg, "plot"), table(request.table, FileFormat::kCsv, "table");
  Comparison comparison = compare_files(request.comparison, work);
  if (plot) plot.fill(svg_of(comparison_plot(comparison)));
  if (table) table.fill(comparison_csv(comparison));
  if (plot) plot.appear();
  if (table) table.appear();
  return comparison;
}

}  // namespace affskel::client
