// The command line, parsed and not run: words of commands and options in any order, and anything between them.
#include <CLI/CLI.hpp>
#include <array>

#include "bytes.h"
#include "client/base/error.h"
#include "client/commands/command_line.h"
#include "targets.h"

namespace affskel::fuzz {
namespace {

constexpr std::size_t kMostWords = 12;

void add_names(const CLI::App& app, std::vector<std::string>& words) {
  for (const CLI::Option* option : app.get_options())
    for (const std::string& name : option->get_lnames()) words.push_back("--" + name);
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    words.push_back(command->get_name());
    add_names(*command, words);
  }
}

const std::vector<std::string>& known_words() {
  static const std::vector<std::string> words = [] {
    std::vector<std::string> all = {"-o",    "-w", "--", "-",   "=",  "@last",
                                    "1e400", "-1", "0",  "nan", "1%", "sphere:9"};
    client::CommandLine line;
    add_names(line.app(), all);
    return all;
  }();
  return words;
}

std::vector<std::string> arguments(Bytes& bytes) {
  std::vector<std::string> words;
  while (!bytes.empty() && words.size() < kMostWords) {
    const unsigned which = bytes.below(4);
    std::string word;
    if (which > 0) word = known_words()[bytes.below_many(known_words().size())];
    if (which == 3) word += '=';
    if (which == 0 || which == 3) word += bytes.take(bytes.below(32));
    words.push_back(word.substr(0, word.find('\0')));
  }
  return words;
}

void run(std::string_view input) {
  Bytes bytes(input);
  const std::vector<std::string> words = arguments(bytes);
  static client::CommandLine line;
  try {
    line.parse(words);
  } catch (const CLI::ParseError& error) {
    if (std::string_view(error.what()).empty() && error.get_exit_code() != 0)
      throw Finding("an error without a word");
  } catch (const client::ClientError&) {
  }
}

std::vector<std::string> seeds() {
  return {{1, 0, 30, 0, 3, 'a', '.', 'b', 1, 0, 31},
          {1, 0, 50, 3, 0, 51, 2, '1', '2'},
          {0, 5, 'h', 'e', 'l', 'p', 'p'}};
}

}  // namespace

const Target kCommandLine = {"command_line", seeds, run, 500};

}  // namespace affskel::fuzz
