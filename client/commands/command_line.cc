#include "client/commands/command_line.h"

#include <CLI/CLI.hpp>
#include <stdexcept>

#include "client/cli/help_format.h"
#include "client/commands/command_parts.h"
#include "wire/params.h"
#include "wire/version.h"

namespace affskel::client {
namespace {

CLI::Validator direction_set() {
  return CLI::Validator(
      [](std::string& text) -> std::string {
        try {
          text = wire::canonical_directions(text);
          return {};
        } catch (const std::invalid_argument& error) {
          return error.what();
        }
      },
      "");
}

void add_submit(CLI::App& app, Options& options) {
  SubmitOptions& o = options.submit;
  CLI::App* sub =
      command(app, options, "submit", Command::kSubmit, "Check a mesh and submit it; prints the job id",
              "  affskel-client submit body.off --spacing 200 -o OUT\n"
              "  affskel-client submit cube.off --points 50000 --directions triangles+sphere:1000 --wait\n"
              "  JOB=$(affskel-client submit body.off --name subject-7)");
  sub->add_option(
         "FILE", o.file,
         "Closed triangle mesh: Geomview OFF text, or .ply .obj .stl .vtp, which are submitted as OFF text")
      ->required()
      ->type_name("");
  sub->add_flag("-w,--wait", o.wait, "Follow the job to its end");
  sub->add_option("-o,--output-dir", o.output_dir,
                  "Wait, then write STEM.field.vtkhdf, STEM.skeleton.ply and STEM.surface.off here")
      ->type_name("DIR");
  CLI::Option* spacing = sub->add_option("--spacing", o.spacing, "Lattice spacing in mesh units")
                             ->check(positive_number())
                             ->type_name("DT");
  sub->add_option("--points", o.points, "Aim at this many sample points")
      ->check(whole_in(1, std::uint64_t{1} << 31))
      ->capture_default_str()
      ->type_name("R")
      ->excludes(spacing);
  sub->add_option("--directions", o.directions, "triangles, sphere:N, random:N:SEED, joined by +")
      ->check(direction_set())
      ->capture_default_str()
      ->type_name("SET");
  sub->add_option("--frame", o.frame,
                  "Axes of the lattice: the mesh's, the principal ones, the least box's, or those that make "
                  "the result affinely invariant")
      ->check(CLI::IsMember({"axis", "pca", "obb", "affine"}))
      ->capture_default_str()
      ->type_name("FRAME");
  add_skeleton_options(sub, o.skeleton);
  sub->add_option("--name", o.name, "Name for people (default: the file's)")
      ->check(utf8_text())
      ->type_name("NAME");
  sub->add_option("--priority", o.priority, "0 .. 9, higher first")
      ->check(whole_in(0, 9))
      ->capture_default_str()
      ->type_name("P");
  sub->add_option("--request-id", o.request_id,
                  "Submitting again with the same key and content gives the same job")
      ->check(utf8_text())
      ->type_name("KEY");
  sub->add_option("--repair", o.repair, "Weld, turn and drop what needs it, and say so, or refuse")
      ->check(CLI::IsMember({"auto", "none"}))
      ->capture_default_str()
      ->type_name("MODE");
}

void add_job_commands(CLI::App& app, Options& options) {
  CLI::App* list =
      command(app, options, "list", Command::kList, "Jobs, newest first",
              "  affskel-client list\n  affskel-client list --state running --state queued --limit 10\n"
              "  affskel-client --json list | jq -r .jobs[].id");
  list->add_option("--state", options.list.states, "Only jobs in this state; may be repeated")
      ->check(CLI::IsMember({"queued", "running", "done", "failed", "cancelled"}))
      ->type_name("STATE")
      ->allow_extra_args(false);
  list->add_option("--owner", options.list.owner, "Only this user's jobs")
      ->check(utf8_text())
      ->type_name("USER");
  list->add_option("--limit", options.list.limit, "At most this many")
      ->check(whole_in(1, 1000000))
      ->capture_default_str()
      ->type_name("N");
  add_job(command(app, options, "status", Command::kStatus, "State, progress and facts of a job",
                  "  affskel-client status @last\n  affskel-client --json status 3f2a9c"),
          options);
  add_job(command(app, options, "watch", Command::kWatch, "Follow a job to its end; prints the final state",
                  "  affskel-client watch @last\n  affskel-client --json watch 3f2a9c"),
          options);
  add_job(command(app, options, "cancel", Command::kCancel, "Stop a job, keeping its progress",
                  "  affskel-client cancel @last"),
          options);
  add_job(command(app, options, "resume", Command::kResume, "Go on with a cancelled or failed job",
                  "  affskel-client resume @last && affskel-client watch @last"),
          options);
  add_job(command(app, options, "delete", Command::kDelete, "Remove a job and everything that belongs to it",
                  "  affskel-client delete 3f2a9c"),
          options);
}

CLI::App* shape(CLI::App* make, Options& options, const std::string& name, Shape which,
                const std::string& description) {
  CLI::App* sub = make->add_subcommand(name, description);
  sub->group("Shapes");
  sub->callback([&options, which] { options.make.shape = which; });
  sub->add_option("-o,--output", options.make.output,
                  "File to write (.off .ply .obj .stl .vtp), or - for OFF on stdout")
      ->required()
      ->type_name("FILE");
  sub->footer("Example:\n  affskel-client make " + name + " -o " + name + ".off");
  return sub;
}

template <typename T>
void dimension(CLI::App* sub, const std::string& name, T& value, const std::string& description,
               const char* type) {
  sub->add_option(name, value, description)->check(positive_number())->capture_default_str()->type_name(type);
}

void triple(CLI::App* sub, const std::string& name, std::vector<double>& values,
            const std::string& description) {
  sub->add_option(name, values, description)
      ->delimiter(',')
      ->expected(3)
      ->check(positive_number())
      ->capture_default_str()
      ->type_name("A,B,C");
}

void add_inspect(CLI::App& app, Options& options) {
  CLI::App* sub = command(app, options, "inspect", Command::kInspect,
                          "What a mesh is, and every defect with its place; needs no server",
                          "  affskel-client inspect body.off\n  affskel-client --json inspect scan.stl");
  sub->add_option("FILE", options.inspect_file, "Geomview OFF text, .ply, .obj, .stl or .vtp")
      ->required()
      ->type_name("");
}

void add_make(CLI::App& app, Options& options) {
  MakeOptions& o = options.make;
  CLI::App* make =
      command(app, options, "make", Command::kMake, "Write a test shape; sizes suit --spacing 200",
              "  affskel-client make body --triangles 500 -o body.off\n"
              "  affskel-client make torus --triangles 256 -o torus.off\n"
              "  affskel-client make box --size 3,2,1 -o - | head -n 2");
  make->require_subcommand(1);
  CLI::App* torus = shape(make, options, "torus", Shape::kTorus, "Torus round the z axis");
  dimension(torus, "--triangles", o.torus_triangles, "Exactly this many (even, >= 18)", "N");
  dimension(torus, "--major", o.major, "Radius of the circle inside the tube", "R");
  dimension(torus, "--minor", o.minor, "Radius of the tube", "R");
  CLI::App* sphere = shape(make, options, "sphere", Shape::kSphere, "Geodesic sphere about the origin");
  dimension(sphere, "--radius", o.radius, "Radius", "R");
  dimension(sphere, "--triangles", o.triangles, "At least this many", "N");
  CLI::App* ellipsoid = shape(make, options, "ellipsoid", Shape::kEllipsoid, "Ellipsoid about the origin");
  triple(ellipsoid, "--axes", o.axes, "Semi-axes along x, y, z");
  dimension(ellipsoid, "--triangles", o.triangles, "At least this many", "N");
  CLI::App* box = shape(make, options, "box", Shape::kBox, "Axis-parallel box with a corner at the origin");
  triple(box, "--size", o.size, "Edges along x, y, z");
  dimension(box, "--divisions", o.divisions, "Each face is cut into 2 N^2 triangles", "N");
  CLI::App* cylinder = shape(make, options, "cylinder", Shape::kCylinder, "Prism round the z axis");
  dimension(cylinder, "--radius", o.cylinder_radius, "Radius", "R");
  dimension(cylinder, "--height", o.cylinder_height, "Height", "H");
  dimension(cylinder, "--segments", o.segments, "Sides (>= 3)", "N");
  CLI::App* cone = shape(make, options, "cone", Shape::kCone, "Pyramid round the z axis, tip up");
  dimension(cone, "--radius", o.cone_radius, "Radius of the base", "R");
  dimension(cone, "--height", o.cone_height, "Height", "H");
  dimension(cone, "--segments", o.segments, "Sides (>= 3)", "N");
  CLI::App* tetrahedron = shape(make, options, "tetrahedron", Shape::kTetrahedron, "Regular tetrahedron");
  dimension(tetrahedron, "--edge", o.edge, "Edge", "A");
  CLI::App* body = shape(make, options, "body", Shape::kBody, "Standing human body, z up, facing -y");
  dimension(body, "--triangles", o.body_triangles, "Exactly this many (even, 200 .. 200000)", "N");
  dimension(body, "--height", o.body_height, "From sole to crown", "H");
}

void add_other_commands(CLI::App& app, Options& options) {
  command(app, options, "server-info", Command::kServerInfo, "Version, workers and queue of the server",
          "  affskel-client server-info\n  affskel-client --server 127.0.0.1:7060 server-info");
  CLI::App* completions = command(
      app, options, "completions", Command::kCompletions, "Completion script for a shell",
      "  affskel-client completions bash > ~/.local/share/bash-completion/completions/affskel-client\n"
      "  affskel-client completions fish > ~/.config/fish/completions/affskel-client.fish");
  completions->add_option("SHELL", options.shell, "Which shell")
      ->required()
      ->check(CLI::IsMember({"bash", "zsh", "fish"}))
      ->type_name("");
}

}  // namespace

void build_command_line(CLI::App& app, Options& options) {
  app.name("affskel-client");
  app.description("Affine skeletons of closed triangle meshes: submit, follow, fetch.");
  app.set_version_flag("--version", std::string("affskel-client ") + wire::kVersion);
  app.fallthrough();  // global options may also follow the command
  app.require_subcommand(1);
  app.formatter(std::make_shared<HelpFormatter>());
  app.add_option("--server", options.global.server,
                 "unix:PATH or HOST:PORT; else $AFFSKEL_SERVER, else the configuration file,\n"
                 "else a private server that starts and leaves by itself")
      ->check(given())
      ->type_name("ADDR");
  app.add_flag("--json", options.global.json, "One JSON document on stdout; errors as JSON on stderr");
  app.add_flag("-q,--quiet", options.global.quiet, "No notes and no progress");
  add_submit(app, options);
  add_job_commands(app, options);
  add_result_commands(app, options);
  add_inspect(app, options);
  add_make(app, options);
  add_shape_file_commands(app, options);
  add_other_commands(app, options);
  app.footer(
      "Examples:\n"
      "  affskel-client make body -o body.off\n"
      "  affskel-client submit body.off --spacing 200 -o OUT\n"
      "  affskel-client render @last -o body.png\n"
      "  affskel-client view @last -o body.html\n"
      "'affskel-client COMMAND --help' tells more. Exit codes: 0 done, 1 job failed, 2 usage, 3 bad input\n"
      "file, 4 no such job or artefact, 5 server unreachable, 6 cancelled, 7 not allowed, 8 limit reached,\n"
      "70 internal error.");
}

}  // namespace affskel::client
