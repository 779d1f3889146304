// Runs targets without libFuzzer: seeds, and what a few random changes make of them.  The same seed gives the same
// inputs on every machine; finds what lies near, in seconds, among all tests.
#include <fcntl.h>
#include <google/protobuf/stubs/logging.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <random>

#include "targets.h"

namespace affskel::fuzz {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLongestInput = 4096;
constexpr std::time_t kSeconds = 5;            // of the processor, for one input
constexpr rlim_t kMemory = rlim_t{512} << 20;  // of the heap
constexpr const char* kFinding = "finding";    // the file of the input that did harm

class Mutator {
 public:
  explicit Mutator(std::uint64_t seed) : random_(seed) {}

  /// One of the inputs, changed at one to eight places.
  std::string next(const std::vector<std::string>& inputs) {
    std::string input = inputs[below(inputs.size())];
    for (std::size_t changes = 1 + below(8); changes > 0; --changes)
      change(input, inputs[below(inputs.size())]);
    if (input.size() > kLongestInput) input.resize(kLongestInput);
    return input;
  }

 private:
  std::size_t below(std::size_t bound) { return static_cast<std::size_t>(random_() % bound); }
  char byte() { return static_cast<char>(random_()); }

  void change(std::string& input, const std::string& other) {
    const std::size_t at = below(input.size() + 1), length = 1 + below(8);
    switch (below(6)) {
      case 0:
        return void(input.insert(at, 1, byte()));
      case 1:
        return void(input.erase(at, length));
      case 2:
        return void(input.insert(at, input.substr(at, length)));
      case 3:
        return void(input.replace(at, length, other.substr(below(other.size() + 1), length)));
      case 4:
        if (at < input.size()) input[at] = static_cast<char>(input[at] ^ 1 << below(8));
        return;
      default:
        if (at < input.size()) input[at] = byte();
    }
  }

  std::mt19937_64 random_;
};

std::string_view under_way;  // the input

// Of an input that takes too long: only what a signal handler may.
extern "C" void keep_and_end(int) {
  const int file = open(kFinding, O_WRONLY | O_CREAT | O_TRUNC, 0666);
  if (file >= 0 && write(file, under_way.data(), under_way.size()) >= 0) close(file);
  constexpr std::string_view kTold = "an input takes more than five seconds; it is in the file finding\n";
  [[maybe_unused]] const auto told = write(STDERR_FILENO, kTold.data(), kTold.size());
  _exit(3);
}

// What libFuzzer bounds, too.
void set_limits() {
  const rlimit memory{kMemory, kMemory};
  setrlimit(RLIMIT_DATA, &memory);
  std::signal(SIGPROF, keep_and_end);
}

void begin_time() {
  const itimerval once{{0, 0}, {kSeconds, 0}};
  setitimer(ITIMER_PROF, &once, nullptr);
}

// Whether the input does no harm; what does is told, and kept.
bool passes(const Target& target, const std::string& input, const std::string& name) {
  under_way = input;
  begin_time();
  try {
    target.run(input);
    return true;
  } catch (const std::exception& error) {
    std::cerr << target.name << ": " << name << ": " << error.what() << '\n';
  }
  return false;
}

void write_file(const fs::path& file, const std::string& bytes) {
  std::ofstream out(file, std::ios::binary);
  if (!(out << bytes).flush()) throw std::runtime_error("cannot write " + file.string());
}

std::string read(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw std::runtime_error("cannot read " + file.string());
  return {std::istreambuf_iterator<char>(in), {}};
}

int run_short(const Target& target, std::size_t runs, std::uint64_t seed) {
  const std::vector<std::string> inputs = target.seeds();
  std::vector<std::string> all = inputs;
  all.emplace_back();  // nothing
  for (const std::string& input : all)
    if (!passes(target, input, "a seed")) return 1;
  Mutator mutator(seed);
  for (std::size_t n = 0; n < runs; ++n) {
    const std::string input = mutator.next(all);
    if (passes(target, input, "input " + std::to_string(n))) continue;
    write_file(kFinding, input);
    std::cerr << "the input is in the file " << kFinding << '\n';
    return 1;
  }
  std::cout << target.name << ": " << all.size() << " seeds and " << runs << " changed inputs\n";
  return 0;
}

int run_files(const Target& target, const std::vector<std::string>& files) {
  int failed = 0;
  for (const std::string& file : files) failed += passes(target, read(file), file) ? 0 : 1;
  return failed > 0 ? 1 : 0;
}

void write_corpus(const Target& target, const fs::path& folder) {
  fs::create_directories(folder);
  std::size_t number = 0;
  for (const std::string& input : target.seeds())
    write_file(folder / ("seed" + std::to_string(number++)), input);
}

}  // namespace
}  // namespace affskel::fuzz

int main(int argc, char** argv) {
  using namespace affskel::fuzz;
  google::protobuf::SetLogHandler(nullptr);  // of every string that is no UTF-8
  CLI::App app("Gives targets changed inputs");
  std::string name, corpus;
  std::vector<std::string> files;
  std::size_t runs = 0;
  std::uint64_t seed = 1;
  app.add_option("TARGET", name)->required();
  app.add_option("FILES", files, "Inputs to run, and nothing else");
  app.add_option("--runs", runs, "Changed inputs (default: the target's short run)");
  app.add_option("--seed", seed, "Of the changes");
  app.add_option("--corpus", corpus, "Folder to write the target's seeds to, instead of running them");
  CLI11_PARSE(app, argc, argv);
  try {
    const Target& target = target_named(name);
    if (!corpus.empty()) return write_corpus(target, corpus), 0;
    set_limits();
    if (!files.empty()) return run_files(target, files);
    return run_short(target, runs > 0 ? runs : target.short_runs, seed);
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 2;
  }
}
