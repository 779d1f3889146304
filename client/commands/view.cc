#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "base/atomic_file.h"
#include "base/number_text.h"
#include "client/cli/value_checks.h"
#include "client/commands/commands.h"
#include "client/commands/shared/destination.h"
#include "client/commands/shared/job_options.h"
#include "client/commands/shared/notices.h"
#include "client/commands/shared/skeleton_options.h"
#include "client/commands/shared/stance_option.h"
#include "client/operations/job_notices.h"
#include "client/operations/page.h"
#include "client/text/words.h"

namespace affskel::client {
namespace {

struct ViewCommandOptions {
  std::vector<std::string> jobs;  // one or two
  std::string output, up;
  std::vector<std::string> operators;  // none, one for all or one for each
  std::vector<double> thresholds;      // the same
  double level = 0;                    // a share of v0
};

// What is given for the one or other of two, or for both.
template <typename Value>
Value given_for(const std::vector<Value>& values, std::size_t which) {
  if (values.empty()) return {};
  return values[std::min(which, values.size() - 1)];
}

std::vector<ViewSubject> subjects_of(Context& context, const ViewCommandOptions& options) {
  const std::size_t count =
      std::max({options.jobs.size(), options.operators.size(), options.thresholds.size()});
  std::vector<ViewSubject> subjects;
  for (std::size_t i = 0; i < count; ++i) {
    ViewSubject subject{finished_job(context.session(), given_for(options.jobs, i)), {}};
    const SkeletonChoice skeleton{given_for(options.operators, i), given_for(options.thresholds, i)};
    subject.params = skeleton_params(skeleton, subject.job);
    subjects.push_back(std::move(subject));
  }
  return subjects;
}

void show_page(Context& context, const Destination& destination, const Page& page) {
  say(context.console(), page.notices);
  const ViewInput& input = page.input;
  const std::size_t bytes = page.html.size();
  std::size_t points = 0;
  for (const ViewModel& model : input.models) points += model.points.size();
  context.console().note("wrote " + destination.name() + " (page, " + std::to_string(bytes) +
                         " bytes): open it in a browser");
  nlohmann::ordered_json jobs = nlohmann::ordered_json::array();
  for (const ViewModel& model : input.models) jobs.push_back(model.job.id());
  context.console().document({{"job", input.models.front().job.id()},
                              {"jobs", jobs},
                              {"artefact", "page"},
                              {"file", destination.name()},
                              {"points", points},
                              {"levels", input.levels},
                              {"bytes", bytes}});
}

void run_view(Context& context, const ViewCommandOptions& options) {
  const Destination destination = destination_of(options.output, "", context.console());
  choose_format(destination, page_formats(), "page");
  base::AtomicFile file(destination.file);
  const ViewOptions look{chosen_stance(options.up), options.level};
  const Page page = make_page(context.session(), subjects_of(context, options), look);
  file.write(page.html);
  file.commit();
  show_page(context, destination, page);
}

void add_skeletons(CLI::App* command, ViewCommandOptions& options) {
  command
      ->add_option(
          "--operator", options.operators,
          "How the skeleton is found (default: the job's operator); given twice, for\nthe one and the "
          "other of two")
      ->allow_extra_args(false)
      ->expected(1, 2)
      ->check(one_of(operator_words()))
      ->type_name("OP");
  command
      ->add_option(
          "--threshold", options.thresholds,
          "Where the slider stands at first (default: the operator's; without\n--operator the job's); "
          "given twice as --operator")
      ->allow_extra_args(false)
      ->expected(1, 2)
      ->check(positive_number())
      ->type_name("T");
}

}  // namespace

void add_view(CommandLine& line) {
  const auto options = std::make_shared<ViewCommandOptions>();
  CLI::App* command =
      line.add("view",
               "Page for any browser: the body, its skeleton and eroded solids to turn, with\n"
               "values under the pointer; one file that needs no network",
               "  affskel-client view @last -o body.html\n"
               "  affskel-client view 3f2a9c --threshold 5 --level 5% -o body.html\n"
               "  affskel-client view 3f2a9c 8b41d0 -o both.html            # two jobs side by side\n"
               "  affskel-client view @last --operator ridge --operator chords -o both.html",
               [options](Context& context) { run_view(context, *options); });
  command
      ->add_option("JOB", options->jobs, "Job id, a unique prefix of 6 characters or more, or @last; or two")
      ->required()
      ->expected(1, 2)
      ->check(job_id());
  add_skeletons(command, *options);
  command
      ->add_option("--level", options->level,
                   "Show the eroded solid at this share of v0 at first: 0.05 or 5%")
      ->transform(proper_share())
      ->type_name("F");
  add_stance(command, options->up);
  add_output(command, options->output, "HTML file to write, or -");
}

}  // namespace affskel::client
