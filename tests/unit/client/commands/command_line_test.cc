#include "client/commands/command_line.h"

#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <array>
#include <cstdio>

#include "client/base/error.h"
#include "client/cli/completions.h"
#include "temp_dir.h"

namespace affskel::client {
namespace {

Options parse(const std::vector<std::string>& arguments) {
  CLI::App app;
  Options options;
  build_command_line(app, options);
  app.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
  return options;
}

TEST(CommandLine, GlobalOptionsMayStandAnywhere) {
  for (const auto& arguments :
       {std::vector<std::string>{"--json", "--server", "unix:/s", "list", "-q"},
        std::vector<std::string>{"list", "--json", "--quiet", "--server", "unix:/s"}}) {
    const Options options = parse(arguments);
    EXPECT_EQ(options.command, Command::kList);
    EXPECT_TRUE(options.global.json);
    EXPECT_TRUE(options.global.quiet);
    EXPECT_EQ(options.global.server, "unix:/s");
  }
}

TEST(CommandLine, SubmitDefaults) {
  const Options options = parse({"submit", "a.off"});
  EXPECT_EQ(options.command, Command::kSubmit);
  EXPECT_EQ(options.submit.file, "a.off");
  EXPECT_EQ(options.submit.spacing, 0);
  EXPECT_EQ(options.submit.points, 100000u);
  EXPECT_EQ(options.submit.directions, "triangles");
  EXPECT_EQ(options.submit.priority, 5u);
  EXPECT_EQ(options.submit.repair, "auto");
  EXPECT_EQ(options.submit.frame, "axis");
  EXPECT_FALSE(options.submit.wait);
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
    EXPECT_THROW(parse(arguments), CLI::ParseError) << extra[0] << " " << extra[1];
  }
}

TEST(CommandLine, KnowsTheFrames) {
  for (const std::string frame : {"axis", "pca", "obb", "affine"}) {
    EXPECT_EQ(parse({"submit", "a.off", "--frame", frame}).submit.frame, frame);
  }
}

TEST(CommandLine, AcceptsUnionsOfDirectionSets) {
  EXPECT_EQ(parse({"submit", "a", "--directions", "triangles+random:7:1+sphere:20"}).submit.directions,
            "triangles+random:7:1+sphere:20");
}

TEST(CommandLine, MakeTakesTheShapesOwnOptions) {
  const Options box = parse({"make", "box", "--size", "3,2,1", "-o", "b.off"});
  EXPECT_EQ(box.command, Command::kMake);
  EXPECT_EQ(box.make.shape, Shape::kBox);
  EXPECT_EQ(box.make.size, (std::vector<double>{3, 2, 1}));
  EXPECT_EQ(parse({"make", "body", "-o", "b.off"}).make.body_height, 18000);
  EXPECT_THROW(parse({"make", "box", "--radius", "3", "-o", "b.off"}), CLI::ParseError);
  EXPECT_THROW(parse({"make", "box", "--size", "3,2", "-o", "b.off"}), CLI::ParseError);
  EXPECT_THROW(parse({"make", "-o", "b.off"}), CLI::ParseError);
}

TEST(CommandLine, KeepsTheOrderOfAffineSteps) {
  const TransformOptions o = parse({"transform", "a.off", "--scale", "2", "--translate", "-1,0,0",
                                    "--scale=3", "--inverse", "-o", "b.off", "--rotate", "x:90"})
                                 .transform;
  std::string steps;
  for (const AffineStep& step : o.steps) steps += step.option + "=" + step.value + " ";
  EXPECT_EQ(steps, "--scale=2 --translate=-1,0,0 --scale=3 --rotate=x:90 ");
  EXPECT_TRUE(o.inverse);
  EXPECT_EQ(o.file, "a.off");
  EXPECT_EQ(o.output, "b.off");
}

TEST(CommandLine, KnowsWhetherSkeletonOptionsWereGiven) {
  EXPECT_FALSE(parse({"skeleton", "@last", "-o", "s.ply"}).job.skeleton.given());
  EXPECT_TRUE(parse({"skeleton", "@last", "-o", "s", "--operator", "zucker-hummel"}).job.skeleton.given());
  EXPECT_TRUE(parse({"surface", "@last", "-o", "s.ply", "--threshold", "3"}).job.skeleton.given());
  EXPECT_EQ(parse({"view", "@last", "-o", "s.html", "--threshold", "3"}).job.skeleton.operator_name, "");
  EXPECT_EQ(parse({"submit", "a.off", "--threshold", "3"}).submit.skeleton.operator_name, "zucker-hummel");
}

// Every command and subcommand of the tree.
void for_each_command(const CLI::App& app, const std::function<void(const CLI::App&)>& visit) {
  for (const CLI::App* child : app.get_subcommands([](const CLI::App*) { return true; })) {
    visit(*child);
    for_each_command(*child, visit);
  }
}

TEST(CommandLine, EveryCommandHasADescriptionAndExamples) {
  CLI::App app;
  Options options;
  build_command_line(app, options);
  int commands = 0;
  for_each_command(app, [&](const CLI::App& command) {
    ++commands;
    EXPECT_FALSE(command.get_description().empty()) << command.get_name();
    EXPECT_NE(command.get_footer().find("affskel-client "), std::string::npos) << command.get_name();
    for (const CLI::Option* option : command.get_options()) {
      EXPECT_FALSE(option->get_description().empty()) << command.get_name() << " " << option->get_name();
    }
  });
  EXPECT_EQ(commands, 20 + 8);
}

std::string script(const std::string& shell) {
  CLI::App app;
  Options options;
  build_command_line(app, options);
  return completion_script(app, shell);
}

TEST(Completions, NameEveryCommandAndLongOption) {
  CLI::App app;
  Options options;
  build_command_line(app, options);
  for (const char* shell : {"bash", "zsh", "fish"}) {
    const std::string text = script(shell);
    for_each_command(app, [&](const CLI::App& command) {
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
  const TempDir dir;
  spit(dir / "completion", script("bash"));
  spit(dir / "run",
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

TEST(Completions, WorkInBash) {
  EXPECT_EQ(completed_by_bash("affskel-client su"), "submit surface ");
  EXPECT_EQ(completed_by_bash("affskel-client --server unix:/s sk"), "skeleton ");
  EXPECT_EQ(completed_by_bash("affskel-client submit --re"), "--request-id --repair ");
  EXPECT_EQ(completed_by_bash("affskel-client submit --repair ''"), "auto none ");
  EXPECT_EQ(completed_by_bash("affskel-client submit --frame ''"), "axis pca obb affine ");
  EXPECT_EQ(completed_by_bash("affskel-client make t"), "torus tetrahedron ");
  EXPECT_EQ(completed_by_bash("affskel-client make torus --m"), "--major --minor ");
  EXPECT_EQ(completed_by_bash("affskel-client compare a.ply b.ply --ra"), "--radius --radii ");
  EXPECT_EQ(completed_by_bash("affskel-client transform --s"), "--scale --shear --server ");
  EXPECT_EQ(completed_by_bash("affskel-client fetch @last s"), "skeleton surface ");
}

}  // namespace
}  // namespace affskel::client
