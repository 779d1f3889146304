// The command line as a person has it: in a terminal, against a real server.
#include "terminal.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <sstream>

#include "lab.h"

namespace affskel::integration {
namespace {

struct Shown {
  int exit_code = 0;
  std::string text;  ///< with "\n" for the terminal's "\r\n"
};

std::string with_plain_line_ends(std::string text) {
  for (std::size_t at = 0; (at = text.find("\r\n", at)) != std::string::npos;) text.erase(at, 1);
  return text;
}

std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; at += part.size()) ++count;
  return count;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

constexpr const char* kNoSuchServer = "unix:/nowhere/affskel.sock";

class TerminalTest : public testing::Test {
 protected:
  TerminalTest() : server_(lab_.server({"--workers", "1"})) {}

  std::vector<std::string> environment() const {
    const std::filesystem::path programs = std::filesystem::path(AFFSKEL_CLIENT_BINARY).parent_path();
    return {"PATH=" + programs.string() + ":/usr/bin:/bin",
            "HOME=" + lab_.path("home"),
            "AFFSKEL_HOME=" + lab_.path("home"),
            "AFFSKEL_SERVER=",
            "LAB=" + lab_.path(""),
            "SERVER=" + lab_.address()};
  }

  /// A line for bash; $LAB is the lab's directory with a slash behind it, $SERVER the server's address, and
  /// `c` the client with that server.
  Shown run(const std::string& line) const {
    Terminal terminal("cd \"$LAB\"; c() { affskel-client --server \"$SERVER\" \"$@\"; }; " + line,
                      environment());
    Shown shown;
    shown.text = with_plain_line_ends(terminal.read_all());
    shown.exit_code = terminal.exit_code();
    return shown;
  }

  void make_box() const {
    lab_.client({"make", "box", "--size", "3000,2000,1000", "-o", lab_.path("box.off")});
  }

  // Of a mesh that takes a while, with the given name.
  std::string start_long_job() const {
    EXPECT_EQ(lab_.client({"make", "body", "--triangles", "20000", "-o", lab_.path("m.off")}).exit_code, 0);
    return lab_.submit({"--points", "200000"});
  }

  Lab lab_;
  Process server_;
};

TEST_F(TerminalTest, WarningsAndASummaryStandWhereTheCommandEnds) {
  make_box();
  const Shown waited = run("c submit box.off --points 800 --wait --name \"it's a box\"");
  EXPECT_EQ(waited.exit_code, 0) << waited.text;
  for (const char* part : {"the directions are only 6 different ones", "the lattice is coarse, ",
                           "submit again with a smaller spacing, such as "}) {
    EXPECT_EQ(count_of(waited.text, part), 1u) << part << "\n" << waited.text;
  }
  EXPECT_GE(count_of(waited.text, "\033[33mwarning:\033[0m "), 2u) << waited.text;
  const std::regex summary(
      "done in [0-9]+\\.[0-9]{3} s: [0-9]+ points, 12 directions, skeleton of [0-9]+ vertices in 1 piece");
  EXPECT_TRUE(std::regex_search(waited.text, summary)) << waited.text;

  // What is proposed can be typed as it stands.
  const std::size_t next = waited.text.find("next: ");
  ASSERT_NE(next, std::string::npos) << waited.text;
  const std::vector<std::string> lines = lines_of(waited.text.substr(next + 6));
  ASSERT_GE(lines.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_NE(lines[i].find("--server " + lab_.address()), std::string::npos) << lines[i];
    const Shown typed = run(lines[i]);
    EXPECT_EQ(typed.exit_code, 0) << lines[i] << "\n" << typed.text;
  }
  EXPECT_TRUE(std::filesystem::exists(lab_.path("it's a box.png")));
  EXPECT_TRUE(std::filesystem::exists(lab_.path("it's a box.html")));

  for (const char* again : {"c watch @last", "c submit box.off --points 800 --name \"it's a box\" -o out"}) {
    const Shown shown = run(again);
    EXPECT_EQ(count_of(shown.text, "the directions are only 6 different ones"), 1u) << shown.text;
    EXPECT_EQ(count_of(shown.text, "next: "), 1u) << shown.text;
    EXPECT_TRUE(std::regex_search(shown.text, summary)) << shown.text;
  }
  const Shown quiet = run("c -q watch @last");
  EXPECT_EQ(count_of(quiet.text, "next: "), 0u);
  EXPECT_EQ(count_of(quiet.text, "the directions are only 6 different ones"), 1u) << "warnings stay";
}

TEST_F(TerminalTest, ASkeletonInMorePiecesThanTheSolidIsToldAtTheEnd) {
  ASSERT_EQ(run("c make body --triangles 300 -o body.off").exit_code, 0);
  const Shown shown = run("c submit body.off --points 8000 --operator zucker-hummel --threshold 14 --wait");
  const auto status = nlohmann::json::parse(lab_.client({"--json", "status", "@last"}).out);
  const int pieces = status.at("quality").at("components");
  ASSERT_GT(pieces, 1) << "the test needs a skeleton that is torn";
  EXPECT_NE(shown.text.find("the skeleton is in " + std::to_string(pieces) + " pieces, the solid in 1"),
            std::string::npos)
      << shown.text;
  EXPECT_NE(shown.text.find(std::to_string(pieces) + " pieces (the solid: 1)"), std::string::npos)
      << shown.text;
}

TEST_F(TerminalTest, HintsRepeatTheServer) {
  const std::string id = start_long_job();
  ASSERT_EQ(lab_.client({"cancel", id}).exit_code, 0);
  const Shown shown = run("c watch @last");
  EXPECT_EQ(shown.exit_code, 6) << shown.text;
  EXPECT_NE(shown.text.find("affskel-client --server " + lab_.address() + " resume " + id), std::string::npos)
      << shown.text;
}

TEST_F(TerminalTest, TheBarKeepsItsWidthAndStatusTellsShareAndTime) {
  const std::string id = start_long_job();
  Terminal watch("affskel-client --server \"$SERVER\" watch " + id, environment());
  watch.read_until("directions");
  v1::Job job = lab_.follow_to_share(id, 0.6);
  ASSERT_EQ(job.state(), v1::JOB_STATE_RUNNING) << "too fast for this test";
  const std::string status = lab_.client({"status", id}).out;
  const auto as_json = nlohmann::json::parse(lab_.client({"--json", "status", id}).out);
  EXPECT_TRUE(std::regex_search(status, std::regex("progress: +[6-9][0-9]\\.[0-9]%\n"))) << status;
  EXPECT_TRUE(std::regex_search(status, std::regex("remaining: +about [0-9]"))) << status;
  EXPECT_GT(as_json.at("remaining_ms").get<std::uint64_t>(), 0u);
  lab_.client({"cancel", id});
  const std::string shown = watch.read_all();
  EXPECT_EQ(watch.exit_code(), 6);
  std::set<std::size_t> widths;
  const std::regex bar("erode +\\[[#.]+\\] +[0-9.]+% +[0-9]+/20000 directions[^\033]*");
  for (auto at = std::sregex_iterator(shown.begin(), shown.end(), bar); at != std::sregex_iterator(); ++at)
    widths.insert(at->str().size());
  EXPECT_EQ(widths.size(), 1u) << shown;
}

// The pipe's reader is gone before anything is written.
TEST_F(TerminalTest, AClosedPipeIsQuiet) {
  make_box();
  ASSERT_EQ(run("c submit box.off --points 500 --wait").exit_code, 0);
  for (const char* command :
       {"c list", "c --json list", "c status @last", "c log @last", "c server-info", "c --help",
        "c submit --help", "c inspect box.off", "c -q --json watch @last", "c completions bash", "c man",
        "c make torus -o -", "c -q fetch @last field --format csv -o -",
        "c -q skeleton @last --format ply -o -", "c -q submit box.off --points 500"}) {
    const Shown shown = run("exec 3> >(exec true); wait $!; " + std::string(command) + " >&3; echo rc=$?");
    EXPECT_EQ(shown.text, "rc=141\n") << command;
  }
  // Closed from the start: whatever is not written must not seem to be.
  for (const char* command : {"c -q list", "c -q fetch @last mesh --format off -o -"}) {
    const std::string said = run(std::string(command) + " >&-; echo rc=$?").text;
    EXPECT_NE(said.find("standard output"), std::string::npos) << said;
    EXPECT_EQ(said.find("rc=0"), std::string::npos) << said;
  }
}

TEST_F(TerminalTest, AMeshCanComeFromStandardInput) {
  const std::vector<std::string> made = {"off", "ply", "obj", "stl", "vtp"};
  for (const std::string& format : made) {
    const Shown shown = run("affskel-client -q make box --size 3000,2000,1000 -o b." + format +
                            " && c submit - <b." + format + " --points 500 --wait --json");
    EXPECT_EQ(shown.exit_code, 0) << format << shown.text;
    EXPECT_NE(shown.text.find("\"name\":\"stdin\""), std::string::npos) << shown.text;
    if (format == "off") continue;
    EXPECT_NE(shown.text.find("stdin: read as " + format), std::string::npos) << shown.text;
  }
  const Shown piped = run("affskel-client make torus -o - | c inspect - | head -n 2");
  EXPECT_NE(piped.text.find("file:                 stdin\nformat:               off\n"), std::string::npos)
      << piped.text;
  const Shown bad = run("echo 'OFF 3 1 0' | c submit -");
  EXPECT_EQ(bad.exit_code, 3);
  EXPECT_NE(bad.text.find("stdin"), std::string::npos) << bad.text;
}

TEST_F(TerminalTest, AWrongWordIsNamedWithTheNearestRightOne) {
  const auto says = [this](const std::string& line, const std::string& text) {
    const Shown shown = run(line);
    EXPECT_EQ(shown.exit_code, 2) << line;
    EXPECT_NE(shown.text.find(text), std::string::npos) << line << "\n" << shown.text;
  };
  says("c submit m.off --spcing 5", "unknown option --spcing; did you mean --spacing?");
  says("c submit m.off --spcing=5", "unknown option --spcing; did you mean --spacing?");
  says("c fetch @last field --ouptut x.csv", "unknown option --ouptut; did you mean --output?");
  says("c list --jsn", "unknown option --jsn; did you mean --json?");
  says("c statsu @last", "no command 'statsu'; did you mean status?");
  says("c make tours -o x.off", "no shape 'tours'; did you mean torus?");
  says("c fetch @last feild", "not 'feild'; did you mean field?");
  says("c surface @last --operator rigde", "not 'rigde'; did you mean ridge?");
  const Shown far = run("c frobnicate");
  EXPECT_EQ(far.text.find("did you mean"), std::string::npos) << far.text;
}

TEST_F(TerminalTest, InspectListsEveryDefectWithItsLine) {
  // Every second triangle of a torus: each edge has one.
  ASSERT_EQ(run("c -q make torus --triangles 256 -o whole.off; awk '/^3 /&&NR%2{next}{print}' whole.off | "
                "awk 'NR==2{$2=128}{print}' >half.off")
                .exit_code,
            0);
  const Shown few = run("c inspect half.off");
  EXPECT_EQ(few.exit_code, 3) << few.text;
  EXPECT_NE(few.text.find("384 edges have a triangle on one side only"), std::string::npos) << few.text;
  EXPECT_NE(few.text.find("; and 379 more (--all)\n"), std::string::npos) << few.text;
  const Shown all = run("c inspect half.off --all 2>/dev/null");
  EXPECT_EQ(count_of(all.text, "\nplace: "), 384u) << all.text;
  EXPECT_EQ(count_of(all.text, " line "), 384u);
  for (const char* option : {"", " --all"}) {
    const auto facts =
        nlohmann::json::parse(run("c --json inspect half.off 2>/dev/null" + std::string(option)).text);
    const auto& places = facts.at("defects").at(0).at("places");
    EXPECT_EQ(places.size(), *option == '\0' ? 5u : 384u);
    for (const auto& place : places) EXPECT_GT(place.at("line").get<int>(), 2);
  }
}

TEST_F(TerminalTest, StatesAreColouredForPeopleAlone) {
  make_box();
  ASSERT_EQ(run("c submit box.off --points 500 --wait").exit_code, 0);
  const std::string done = "\033[32mdone\033[0m";
  EXPECT_NE(run("c list").text.find(done), std::string::npos) << run("c list").text;
  EXPECT_NE(run("c status @last").text.find("\033[32mstate:                done\033[0m\n"),
            std::string::npos);
  EXPECT_NE(run("c status @last").text.find("\033[33mwarning: "), std::string::npos);
  for (const char* plain : {"NO_COLOR=1 c list", "c -q list", "c list | cat", "c --json list",
                            "TERM=dumb c list", "NO_COLOR=1 c status @last", "c status @last | cat"}) {
    const Shown shown = run(plain);
    EXPECT_NE(shown.text.find("done"), std::string::npos) << plain;
    EXPECT_EQ(shown.text.find('\033'), std::string::npos) << plain << shown.text;
  }
  // Columns stand where they do without colours; the age goes on.
  const auto bare = [](const std::string& text) {
    return std::regex_replace(text, std::regex("\033\\[[0-9]*m|[0-9]+\\.[0-9] s +"), "");
  };
  EXPECT_EQ(bare(run("c list").text), bare(run("c list | cat").text));
}

TEST_F(TerminalTest, TabCompletesJobsAndMeshFiles) {
  make_box();
  const std::string id = lab_.client({"submit", lab_.path("box.off"), "--points", "500"}).out;
  lab_.write("box.txt", "no mesh");
  Terminal bash("", environment());
  bash.read_until("$ ");
  bash.type("cd \"$LAB\" && source <(affskel-client completions bash) && echo sour''ced\r");
  bash.read_until("sourced\r\n");
  bash.type("affskel-client --server " + lab_.address() + " status " + id.substr(0, 6) +
            "\t; echo en''ded\r");
  EXPECT_NE(bash.read_until("ended\r\n").find("status " + id.substr(0, 12) + " "), std::string::npos);
  bash.type("affskel-client inspect bo\t; echo en''ded\r");
  EXPECT_NE(bash.read_until("ended\r\n").find("inspect box.off "), std::string::npos);
  // Neither a server nor the data of one: nothing comes, nothing is said, and none is started.
  bash.type("affskel-client status " + id.substr(0, 6) + "\t; echo en''ded\r");
  const std::string none = bash.read_until("ended\r\n");
  EXPECT_EQ(none.find(id.substr(0, 12)), std::string::npos) << none;
  bash.type("affskel-client job-ids --line 'affskel-client --server " + std::string(kNoSuchServer) +
            " status '; echo rc=$?\r");
  EXPECT_NE(bash.read_until("rc=0\r\n").find("status '; echo rc=$?\r\n"), std::string::npos);
  EXPECT_EQ(lab_.run({AFFSKEL_CLIENT_BINARY, "job-ids"},
                     {"AFFSKEL_HOME=" + lab_.path("no-home"), "AFFSKEL_SERVER="})
                .out,
            "");
  EXPECT_FALSE(std::filesystem::exists(lab_.path("no-home")));
  bash.type("exit\r");
  bash.read_all();
}

TEST_F(TerminalTest, TabCompletesInZsh) {
  if (!std::filesystem::exists("/usr/bin/zsh"))
    GTEST_SKIP() << "zsh, whose completion is tried, is not installed; deploy/run-tests installs it";
  make_box();
  const std::string id = lab_.client({"submit", lab_.path("box.off"), "--points", "500"}).out;
  lab_.write("box.txt", "no mesh");
  Terminal zsh("cd \"$LAB\"; exec zsh -f -i", environment());
  zsh.type(
      "PS1='$ '; unsetopt zle_bracketed_paste; autoload -Uz compinit && compinit -D -u; "
      "source <(affskel-client completions zsh); echo sour''ced\r");
  zsh.read_until("sourced\r\n");
  zsh.type("echo affskel-client; affskel-client --server " + lab_.address() + " status " + id.substr(0, 6) +
           "\t | head -n 1; echo en''ded\r");
  EXPECT_NE(zsh.read_until("ended\r\n").find("job:                  " + id.substr(0, 32)), std::string::npos);
  zsh.type("affskel-client inspect bo\t | head -n 1; echo en''ded\r");
  EXPECT_NE(zsh.read_until("ended\r\n").find("file:                 box.off\r\n"), std::string::npos);
  zsh.type("exit\r");
  zsh.read_all();
}

TEST_F(TerminalTest, TabCompletesInFish) {
  if (!std::filesystem::exists("/usr/bin/fish"))
    GTEST_SKIP() << "fish, whose completion is tried, is not installed; deploy/run-tests installs it";
  make_box();
  const std::string id = lab_.client({"submit", lab_.path("box.off"), "--points", "500"}).out;
  const auto offered = [this](const std::string& line) {
    return run("fish -N -c 'source (affskel-client completions fish | psub); complete -C \"" + line + "\"'")
        .text;
  };
  const std::string jobs =
      offered("affskel-client --server " + lab_.address() + " status " + id.substr(0, 6));
  EXPECT_NE(jobs.find(id.substr(0, 12) + "\t"), std::string::npos) << jobs;
  EXPECT_NE(offered("affskel-client inspect bo").find("box.off"), std::string::npos);
  EXPECT_NE(offered("affskel-client submit x.off --spa").find("--spacing"), std::string::npos);
}

TEST_F(TerminalTest, TimesAndVolumesHaveTheirDigits) {
  make_box();
  ASSERT_EQ(run("c submit box.off --points 500 --wait").exit_code, 0);
  const std::string status = run("c status @last | cat").text;
  EXPECT_NE(status.find("v0:                   6000000000\n"), std::string::npos) << status;
  const auto job = nlohmann::json::parse(lab_.client({"--json", "status", "@last"}).out);
  const std::uint64_t ms =
      job.at("finished_ms").get<std::uint64_t>() - job.at("started_ms").get<std::uint64_t>();
  char took[32];
  std::snprintf(took, sizeof took, "%.3f s", static_cast<double>(ms) / 1000);
  EXPECT_NE(status.find("took:                 " + std::string(took) + "\n"), std::string::npos)
      << took << status;
  EXPECT_NE(run("c inspect box.off").text.find("volume:               6000000000\n"), std::string::npos);
}

TEST_F(TerminalTest, TheSameMeshUnderAnotherNameIsNotComputedAgain) {
  make_box();
  ASSERT_EQ(run("c submit box.off --points 500 --wait").exit_code, 0);
  const Shown again = run("cp box.off other.off; c submit other.off --points 500 --wait");
  EXPECT_EQ(again.exit_code, 0);
  EXPECT_NE(again.text.find("the field is taken over"), std::string::npos) << again.text;
  EXPECT_NE(again.text.find(", its field being there already: "), std::string::npos) << again.text;
  const auto job = nlohmann::json::parse(lab_.client({"--json", "status", "@last"}).out);
  EXPECT_EQ(job.at("name"), "other");
  EXPECT_EQ(job.at("counters").at("directions_reported"), 0);
  EXPECT_EQ(job.at("directions_done"), 12);
}

TEST_F(TerminalTest, ManualAndCompletionsAreInstalled) {
  const Shown installed =
      run(std::string(AFFSKEL_CMAKE) + " --install " AFFSKEL_CLIENT_BUILD " --prefix \"$LAB\"usr");
  ASSERT_EQ(installed.exit_code, 0) << installed.text;
  for (const char* file :
       {"usr/share/man/man1/affskel-client.1", "usr/share/bash-completion/completions/affskel-client",
        "usr/share/zsh/site-functions/_affskel-client",
        "usr/share/fish/vendor_completions.d/affskel-client.fish"}) {
    EXPECT_TRUE(std::filesystem::exists(lab_.path(file))) << file;
  }
  EXPECT_EQ(lab_.read("usr/share/man/man1/affskel-client.1"), lab_.run({AFFSKEL_CLIENT_BINARY, "man"}).out);
  if (!std::filesystem::exists("/usr/bin/groff"))
    GTEST_SKIP() << "groff, which renders the page, is not installed; deploy/run-tests installs it";
  const Shown warnings = run("groff -man -Tutf8 -ww -z usr/share/man/man1/affskel-client.1");
  EXPECT_EQ(warnings.text, "");
  EXPECT_EQ(warnings.exit_code, 0);
  const std::string page = run("groff -man -Tutf8 -P-cbou usr/share/man/man1/affskel-client.1").text;
  for (const char* part : {"--spacing DT", "submit FILE [OPTIONS]", "make torus [OPTIONS]", "EXIT STATUS",
                           "affskel-client submit body.off -o OUT"}) {
    EXPECT_NE(page.find(part), std::string::npos) << part;
  }
}

TEST_F(TerminalTest, WhatAnObjHoldsBesideItsMeshIsNamedOnce) {
  make_box();
  ASSERT_EQ(run("c -q transform box.off --scale 1 -o plain.obj").exit_code, 0);
  // Continued lines, normals, groups.
  ASSERT_EQ(run("{ echo 'mtllib none.mtl'; sed -e 's/^f \\([^ ]*\\) /f \\1 \\\\\\n/' plain.obj; echo 'vn 0 0 "
                "1'; echo "
                "'vn 0 1 0'; echo 'g a'; } >rich.obj; grep -c '\\\\$' rich.obj")
                .text,
            "12\n");
  const Shown shown = run("c submit rich.obj --points 500 --wait");
  EXPECT_EQ(shown.exit_code, 0) << shown.text;
  EXPECT_EQ(count_of(shown.text,
                     "rich.obj: passed over 1 row of mtllib (materials), 2 rows of vn (normals), "
                     "1 row of g (groups)"),
            1u)
      << shown.text;
  const Shown facts = run("c inspect rich.obj");
  EXPECT_NE(facts.text.find("passed_over:          2 of vn, first in line "), std::string::npos)
      << facts.text;
  EXPECT_NE(facts.text.find("triangles:            12\n"), std::string::npos) << facts.text;
}

TEST_F(TerminalTest, WhatLeavesTheRidgeIsNamed) {
  make_box();
  ASSERT_EQ(run("c submit box.off --points 3000 --directions sphere:80 --wait").exit_code, 0);
  const auto says = [this](const std::string& options, const std::string& text) {
    const Shown shown = run("c surface @last -o s.ply " + options);
    EXPECT_EQ(shown.exit_code, 2) << options << shown.text;
    EXPECT_NE(shown.text.find(text), std::string::npos) << options << "\n" << shown.text;
  };
  says("--alpha 500", "alpha is for point skeletons; the sheet of ridge has triangles of its own");
  says("--operator zucker-hummel --barrier", "the operator zucker-hummel gives points or lines");
  says("--operator ridge --threshold 900", "between 1e-06 and 800, not 900");
  says("--operator ridge --threshold 1e-7", "between 1e-06 and 800, not 1e-07");
  says("--operator curve --threshold 0.5", "between 0.9 and 1000, not 0.5");
  says("--operator curve --barrier", "barriers are for the sheets of chords and ridge");
}

}  // namespace
}  // namespace affskel::integration
