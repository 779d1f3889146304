// Runs targets without libFuzzer: seeds, and what a few random changes make of them.  The same seed gives the same
// inputs on every machine; finds what lies near, in seconds, among all tests.
#include <google/protobuf/stubs/logging.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <random>

#include "targets.h"

namespace affskel::fuzz {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLongestInput = 4096;

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

// Whether the input does no harm; what does is told, and kept.
bool passes(const Target& target, const std::string& input, const std::string& name) {
  try {
    target.run(input);
    return true;
  } catch (const std::exception& error) {
    std::cerr << target.name << ": " << name << ": " << error.what() << '\n';
  }
  return false;
}

void write(const fs::path& file, const std::string& bytes) {
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
    write("finding", input);
    std::cerr << "the input is in the file finding\n";
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
  for (const std::string& input : target.seeds()) write(folder / ("seed" + std::to_string(number++)), input);
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
    if (!files.empty()) return run_files(target, files);
    return run_short(target, runs > 0 ? runs : target.short_runs, seed);
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 2;
  }
}
