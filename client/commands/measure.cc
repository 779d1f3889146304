#include <CLI/CLI.hpp>
#include <array>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "base/atomic_file.h"
#include "client/cli/value_checks.h"
#include "client/commands/commands.h"
#include "client/commands/shared/destination.h"
#include "client/commands/shared/job_options.h"
#include "client/commands/shared/notices.h"
#include "client/operations/measures_text.h"

namespace affskel::client {
namespace {

constexpr std::array kFormats = {FileFormat::kCsv, FileFormat::kJson};

struct MeasureOptions {
  std::string job, output, format;
  double threshold = 0;
};

// A file that is opened before the work is done.
class MeasuresFile {
 public:
  explicit MeasuresFile(const Destination& destination)
      : format_(choose_format(destination, kFormats, "measures")), file_(destination.file) {}

  void write(const Measures& measures) {
    file_.write(format_ == FileFormat::kCsv ? measures_csv(measures)
                                            : measures_json(measures).dump(1) + "\n");
    file_.commit();
  }

 private:
  FileFormat format_;
  base::AtomicFile file_;
};

void run_measure(Context& context, const MeasureOptions& options) {
  Console& console = context.console();
  std::optional<MeasuresFile> file;
  if (!options.output.empty()) file.emplace(destination_of(options.output, options.format, console));
  const Measures measures = measure(context.session(), options.job, options.threshold);
  say(console, measures.notices);
  nlohmann::ordered_json document = measures_json(measures);
  if (file) {
    file->write(measures);
    if (options.output == "-") return;
    console.note("wrote " + options.output);
    document["file"] = options.output;
  } else {
    console.result(measures_text(measures));
  }
  console.document(document);
}

}  // namespace

void add_measure(CommandLine& line) {
  const auto options = std::make_shared<MeasureOptions>();
  CLI::App* command = line.add(
      "measure", "The solid and its limbs in numbers, by the curve skeleton",
      "  affskel-client measure @last\n"
      "  affskel-client measure @last -o limbs.csv\n"
      "  affskel-client measure @last --threshold 3        # long limbs alone\n"
      "A part is a branch of the curve with what of the solid is nearest to it, the\n"
      "largest first, but by their places in a row where each has 95 % of the one before\n"
      "or more: limbs end freely, links join limbs, loops close, a line ends\n"
      "freely at both ends; a point is the body that others hang on, its radius that of a ball as large, or a solid\n"
      "without limbs.  Lengths are in the units of the mesh, without what of a line runs within such a body; angles\n"
      "are those with the heaviest other branch at the joint, which is part \"to\", 180 where they lie straight",
      [options](Context& context) { run_measure(context, *options); });
  add_job(command, options->job);
  command
      ->add_option("--threshold", options->threshold,
                   "The shortest limb that counts, in its own radii (default and least: 0.9)")
      ->check(positive_number())
      ->type_name("T");
  CLI::Option* output =
      command->add_option("-o,--output", options->output, "File to write: .csv or .json; - is stdout");
  output->check(non_empty())->type_name("FILE");
  add_format(command, options->format);
  command->get_option("--format")->needs(output);
}

}  // namespace affskel::client
