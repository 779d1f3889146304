#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <system_error>

#include "client/cli/shell_words.h"
#include "client/commands/commands.h"
#include "client/connection/embedded_server.h"
#include "client/text/job_text.h"
#include "client/text/printable.h"
#include "client/text/words.h"

namespace affskel::client {
namespace {

constexpr std::size_t kMaxJobs = 50;
constexpr std::chrono::milliseconds kTabPatience{1000};  // of a person who has pressed TAB

// What is given to reach the server in a line that is still being typed.
GlobalOptions options_in(const std::string& line) {
  GlobalOptions options;
  CLI::App app;
  add_global_options(app, options);
  app.allow_extras();
  std::vector<std::string> words = shell_words(line);
  if (words.empty()) return options;
  words.erase(words.begin());
  std::reverse(words.begin(), words.end());  // as CLI11 takes them
  try {
    app.parse(words);
  } catch (const CLI::ParseError&) {
    return {};
  }
  return options;
}

// The private server only where it has been before: then it is started again if it has left.
std::optional<ServerChoice> server_in_reach(const GlobalOptions& options, Context& context) {
  const Environment& environment = context.environment();
  ServerChoice choice = choose_server(options.server, environment, options.access);
  if (!choice.embedded) return choice;
  const EmbeddedPaths paths = embedded_paths(environment);
  std::error_code unseen;
  if (!std::filesystem::exists(paths.home / "affskel.db", unseen)) return std::nullopt;
  EmbeddedOptions start;
  start.patience = kTabPatience;
  choice.address = ensure_embedded_server(paths, start, environment, {});
  choice.embedded = false;
  return choice;
}

std::string lines_of(const std::vector<v1::Job>& jobs) {
  std::string text;
  for (const v1::Job& job : jobs) {
    // Shells expand what they are offered.
    if (job.id().find_first_not_of("0123456789abcdef") != std::string::npos) continue;
    text += short_id(job) + "\t" + state_word(job.state()) + " " + one_line(job.name()) + "\n";
  }
  return text;
}

// Why nothing comes is no completion: it is not told.
void run_job_ids(Context& context, const std::string& line) {
  RetryPolicy policy;
  policy.patience = std::chrono::milliseconds(0);
  policy.call_deadline = kTabPatience;
  try {
    const auto choice = server_in_reach(options_in(line), context);
    if (!choice) return;
    Session session(*choice, context.environment(), {}, policy);
    context.console().result(lines_of(session.list_jobs({}, kMaxJobs)));
  } catch (const ClientError& error) {
    if (error.exit_code() == ExitCode::kClosedPipe) throw;
  }
}

}  // namespace

void add_job_ids(CommandLine& line) {
  const auto typed = std::make_shared<std::string>();
  CLI::App* command =
      line.add("job-ids", "Ids, states and names of the newest jobs, for completions",
               "  affskel-client job-ids --line 'affskel-client --server unix:/run/s status '",
               [typed](Context& context) { run_job_ids(context, *typed); });
  command->group("");  // not in the help: shells call it
  command->add_option("--line", *typed, "What is typed so far: its --server and what goes with it count")
      ->type_name("LINE");
}

}  // namespace affskel::client
