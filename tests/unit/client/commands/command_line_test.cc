#include "client/commands/command_line.h"

#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <array>
#include <cstdio>

#include "client/base/error.h"
#include "client/cli/affine_steps.h"
#include "client/cli/completions.h"
#include "client/commands/shared/skeleton_options.h"
#include "core/base/error.h"
#include "core/files/read/parse_shape.h"
#include "tools/files.h"
#include "tools/temporary_directory.h"

namespace affskel::client {
namespace {

// A command line that was parsed, and its options.
class Parsed {
 public:
  explicit Parsed(const std::vector<std::string>& arguments) { line_.parse(arguments); }

  const GlobalOptions& global() const { return line_.global(); }
  /// "list", or "make box".
  std::string command() {
    std::string words;
    for (const CLI::App* level = first(); level != nullptr; level = first(*level)) {
      words += (words.empty() ? "" : " ") + level->get_name();
    }
    return words;
  }
  bool given(const std::string& option) { return last().count(option) > 0; }
  /// Its value, or its default.
  template <typename T = std::string>
  T value(const std::string& option) {
    return last().get_option(option)->as<T>();
  }

 private:
  const CLI::App* first() { return first(line_.app()); }
  static const CLI::App* first(const CLI::App& app) {
    const auto chosen = app.get_subcommands();
    return chosen.empty() ? nullptr : chosen.front();
  }
  const CLI::App& last() {
    const CLI::App* level = &line_.app();
    while (const CLI::App* next = first(*level)) level = next;
    return *level;
  }

  CommandLine line_;
};

TEST(CommandLine, GlobalOptionsMayStandAnywhere) {
  for (const auto& arguments :
       {std::vector<std::string>{"--json", "--server", "unix:/s", "list", "-q"},
        std::vector<std::string>{"list", "--json", "--quiet", "--server", "unix:/s"}}) {
    Parsed parsed(arguments);
    EXPECT_EQ(parsed.command(), "list");
    EXPECT_TRUE(parsed.global().json);
    EXPECT_TRUE(parsed.global().quiet);
    EXPECT_EQ(parsed.global().server, "unix:/s");
  }
}

TEST(CommandLine, SubmitDefaults) {
  Parsed parsed({"submit", "a.off"});
  EXPECT_EQ(parsed.command(), "submit");
  EXPECT_EQ(parsed.value("FILE"), "a.off");
  EXPECT_FALSE(parsed.given("--spacing"));
  EXPECT_EQ(parsed.value<std::uint64_t>("--points"), 100000u);
  EXPECT_EQ(parsed.value("--directions"), "triangles");
  EXPECT_EQ(parsed.value<unsigned>("--priority"), 5u);
  EXPECT_EQ(parsed.value("--repair"), "auto");
  EXPECT_EQ(parsed.value("--frame"), "axis");
  EXPECT_FALSE(parsed.given("--wait"));
}

TEST(CommandLine, RefusesValuesOutOfRange) {
  for (const std::vector<std::string>& extra :
       std::vector<std::vector<std::string>>{{"--spacing", "0"},
                                             {"--spacing", "-1"},
                                             {"--spacing", "nan"},
                                             {"--spacing", "inf"},
                                             {"--spacing", "2x"},
                                             {"--spacing", ""},
                                             {"--points", "0"},
                                             {"--points", "2147483649"},
                                             {"--points", "1.5"},
                                             {"--spacing", "2", "--points", "3"},
                                             {"--priority", "10"},
                                             {"--priority", "-1"},
                                             {"--directions", "sphere"},
                                             {"--directions", "sphere:0"},
                                             {"--directions", "random:10"},
                                             {"--directions", "triangles+"},
                                             {"--operator", "laplace"},
                                             {"--threshold", "0"},
                                             {"--repair", "maybe"},
                                             {"--frame", "world"},
                                             {"--frame", ""}}) {
    std::vector<std::string> arguments = {"submit", "a.off"};
    arguments.insert(arguments.end(), extra.begin(), extra.end());
    EXPECT_THROW(Parsed{arguments}, CLI::ParseError) << extra[0] << " " << extra[1];
  }
}

TEST(CommandLine, KnowsTheFrames) {
  for (const std::string frame : {"axis", "pca", "obb", "affine"}) {
    EXPECT_EQ(Parsed({"submit", "a.off", "--frame", frame}).value("--frame"), frame);
  }
}

TEST(CommandLine, AcceptsUnionsOfDirectionSets) {
  EXPECT_EQ(Parsed({"submit", "a", "--directions", "triangles+random:7:1+sphere:20"}).value("--directions"),
            "triangles+random:7:1+sphere:20");
}

TEST(CommandLine, MakeTakesTheShapesOwnOptions) {
  Parsed box({"make", "box", "--size", "3,2,1", "-o", "b.off"});
  EXPECT_EQ(box.command(), "make box");
  EXPECT_EQ(box.value<std::vector<double>>("--size"), (std::vector<double>{3, 2, 1}));
  EXPECT_EQ(Parsed({"make", "body", "-o", "b.off"}).value<double>("--height"), 18000);
  EXPECT_THROW(Parsed({"make", "box", "--radius", "3", "-o", "b.off"}), CLI::ParseError);
  EXPECT_THROW(Parsed({"make", "box", "--size", "3,2", "-o", "b.off"}), CLI::ParseError);
  EXPECT_THROW(Parsed({"make", "-o", "b.off"}), CLI::ParseError);
}

TEST(CommandLine, KeepsTheOrderOfAffineSteps) {
  CLI::App app;
  AffineStepOptions options;
  options.add_to(&app);
  app.parse(
      std::vector<std::string>{"x:90", "--rotate", "--scale=3", "-1,0,0", "--translate", "2", "--scale"});
  std::string steps;
  for (const AffineStep& step : options.in_order()) steps += step.option + "=" + step.value + " ";
  EXPECT_EQ(steps, "--scale=2 --translate=-1,0,0 --scale=3 --rotate=x:90 ");
  Parsed parsed({"transform", "a.off", "--scale", "2", "--translate", "-1,0,0", "--scale=3", "--inverse",
                 "-o", "b.off", "--rotate", "x:90"});
  EXPECT_TRUE(parsed.given("--inverse"));
  EXPECT_EQ(parsed.value("FILE"), "a.off");
  EXPECT_EQ(parsed.value("--output"), "b.off");
}

SkeletonChoice parsed_skeleton(const std::vector<std::string>& reversed_arguments,
                               SkeletonChoice skeleton = {}) {
  CLI::App app;
  add_skeleton_options(&app, skeleton);
  app.parse(std::vector<std::string>(reversed_arguments));
  return skeleton;
}

TEST(CommandLine, KnowsWhetherSkeletonOptionsWereGiven) {
  EXPECT_EQ(parsed_skeleton({}).operator_name, "");
  EXPECT_EQ(parsed_skeleton({}).threshold, 0);
  EXPECT_EQ(parsed_skeleton({"zucker-hummel", "--operator"}).operator_name, "zucker-hummel");
  EXPECT_EQ(parsed_skeleton({"3", "--threshold"}).threshold, 3);
  EXPECT_EQ(parsed_skeleton({"3", "--threshold"}).operator_name, "");
  for (const char* command : {"skeleton", "surface", "view", "render"}) {
    Parsed parsed({command, "@last", "-o", "s.ply", "--threshold", "3"});
    EXPECT_TRUE(parsed.given("--threshold")) << command;
    EXPECT_FALSE(parsed.given("--operator")) << command;
    EXPECT_EQ(parsed.value<double>("--threshold"), 3) << command;
  }
  EXPECT_EQ(Parsed({"submit", "a.off", "--threshold", "3"}).value("--operator"), "ridge");
}

// Every command and subcommand of the tree.
void for_each_command(const CLI::App& app, const std::function<void(const CLI::App&)>& visit) {
  for (const CLI::App* child : app.get_subcommands([](const CLI::App*) { return true; })) {
    visit(*child);
    for_each_command(*child, visit);
  }
}

TEST(CommandLine, EveryCommandHasADescriptionAndExamples) {
  CommandLine line;
  int commands = 0;
  for_each_command(line.app(), [&](const CLI::App& command) {
    ++commands;
    EXPECT_FALSE(command.get_description().empty()) << command.get_name();
    EXPECT_NE(command.get_footer().find("affskel-client "), std::string::npos) << command.get_name();
    for (const CLI::Option* option : command.get_options()) {
      EXPECT_FALSE(option->get_description().empty()) << command.get_name() << " " << option->get_name();
    }
  });
  EXPECT_EQ(commands, 30 + 8);
}

std::string script(const std::string& shell) {
  CommandLine line;
  return completion_script(line.app(), shell);
}

TEST(Completions, NameEveryCommandAndLongOption) {
  CommandLine line;
  for (const char* shell : {"bash", "zsh", "fish"}) {
    const std::string text = script(shell);
    for_each_command(line.app(), [&](const CLI::App& command) {
      if (command.get_group().empty()) return;  // for shells, not for people
      EXPECT_NE(text.find(command.get_name()), std::string::npos) << shell << " " << command.get_name();
      for (const CLI::Option* option : command.get_options()) {
        for (const std::string& name : option->get_lnames()) {
          const std::string shown = std::string(shell) == "fish" ? "-l " + name : "--" + name;
          EXPECT_NE(text.find(shown), std::string::npos) << shell << " " << command.get_name() << " " << name;
        }
      }
    });
  }
  EXPECT_THROW(script("tcsh"), ClientError);
}

// What bash offers for a command line whose last word is being typed.
std::string completed_by_bash(const std::string& words) {
  const tests::TemporaryDirectory dir;
  tests::write_file(dir / "completion", script("bash"));
  tests::write_file(
      dir / "run",
      "source '" + (dir / "completion") + "'\nCOMP_WORDS=(" + words +
          ")\nCOMP_CWORD=$((${#COMP_WORDS[@]}-1))\n_affskel_client\nprintf '%s ' \"${COMPREPLY[@]}\"\n");
  std::FILE* pipe = popen(("bash '" + (dir / "run") + "'").c_str(), "r");
  std::string text;
  std::array<char, 4096> buffer{};
  while (const std::size_t got = std::fread(buffer.data(), 1, buffer.size(), pipe))
    text.append(buffer.data(), got);
  EXPECT_EQ(pclose(pipe), 0) << words;
  return text;
}

TEST(Completions, OfferEveryKindOfMeshThatIsRead) {
  const tests::TemporaryDirectory dir;
  for (const char* name : {"a.off", "b.GLB", "c.3mf.gz", "d.stl.zst", "e.nrrd", "f.nii.gz", "g.txt", "h.gz"})
    tests::write_file(dir / name, "");
  std::string offered = completed_by_bash("affskel-client inspect '" + (dir / "") + "'");
  for (const char* name : {"a.off", "b.GLB", "c.3mf.gz", "d.stl.zst", "e.nrrd", "f.nii.gz"})
    EXPECT_NE(offered.find((dir / name) + " "), std::string::npos) << name;
  for (const char* name : {"g.txt", "h.gz"}) EXPECT_EQ(offered.find(name), std::string::npos) << name;
  for (const char* shell : {"zsh", "fish"})
    EXPECT_NE(script(shell).find("3mf.zst"), std::string::npos) << shell;
  for (const std::string_view extension : core::mesh_extensions()) {
    try {
      core::parse_shape(extension, "");
    } catch (const core::CoreError& error) {
      EXPECT_EQ(std::string(error.what()).find("not a known kind"), std::string::npos) << extension;
    }
  }
}

TEST(Completions, WorkInBash) {
  EXPECT_EQ(completed_by_bash("affskel-client su"), "submit surface ");
  EXPECT_EQ(completed_by_bash("affskel-client --server unix:/s sk"), "skeleton ");
  EXPECT_EQ(completed_by_bash("affskel-client submit --re"),
            "--request-id --repair --read-limit --repair-limit ");
  EXPECT_EQ(completed_by_bash("affskel-client submit --repair ''"), "auto none wrap wrap= fill= ");
  EXPECT_EQ(completed_by_bash("affskel-client submit --frame ''"), "axis pca obb affine ");
  EXPECT_EQ(completed_by_bash("affskel-client make t"), "torus tetrahedron ");
  EXPECT_EQ(completed_by_bash("affskel-client make torus --m"), "--major --minor --memory ");
  EXPECT_EQ(completed_by_bash("affskel-client compare a.ply b.ply --ra"), "--radius --radii ");
  EXPECT_EQ(completed_by_bash("affskel-client transform --s"), "--scale --shear --server ");
  EXPECT_EQ(completed_by_bash("affskel-client fetch @last s"), "skeleton surface source ");
}

}  // namespace
}  // namespace affskel::client
