#include <CLI/CLI.hpp>
#include <array>
#include <map>
#include <memory>

#include "client/commands/command_parts.h"

namespace affskel::client {
namespace {

void add_file(CLI::App* sub, const std::string& name, std::string& file, const std::string& what) {
  sub->add_option(name, file, what)->required()->check(given())->type_name("FILE");
}

void add_compare(CLI::App& app, Options& options) {
  CompareOptions& o = options.compare;
  CLI::App* sub = command(
      app, options, "compare", Command::kCompare, "Similarity of two skeleton files; needs no server",
      "  affskel-client compare a.ply b.ply --plot curve.svg\n"
      "  affskel-client compare a.ply b.ply --solid body.off -o curve.csv\n"
      "  affskel-client compare a.csv b.csv --squared --radii 1.2e5,1e6,1e7,1e8\n"
      "The table tells the share of A's points within r of B and back; its area under the curve is taken up\n"
      "to the largest r and divided by it. Points: .csv .ply .off .xyz .vtp .dat; surfaces: .off .ply .obj\n"
      ".stl .vtp, compared by points spread evenly over them.");
  add_file(sub, "A", o.a, "Skeleton: points or a surface");
  add_file(sub, "B", o.b, "The other one");
  sub->add_option("--radius", o.radius,
                  "Radius that matters (default: sqrt(3)/128 of the longest side of the solid's\n"
                  "box, or of the skeletons' without --solid)")
      ->check(positive_number())
      ->type_name("R");
  sub->add_option("--radii", o.radii, "Radii of the table, comma-separated (default: 0 to 4 R in 16 steps)")
      ->check(given())
      ->type_name("LIST");
  sub->add_flag("--squared", o.squared, "Radii are given and shown squared, as in the published work");
  sub->add_option("--solid", o.solid,
                  "Mesh of the solid: adds the chance level, the share of its inside within r")
      ->check(given())
      ->type_name("FILE");
  sub->add_option("--samples", o.samples, "Points to spread over each surface")
      ->check(whole_in(1, 100000000))
      ->capture_default_str()
      ->type_name("N");
  sub->add_option("--plot", o.plot, "Write the curves as a plot (.svg)")->check(given())->type_name("FILE");
  sub->add_option("-o,--output,--csv", o.output, "Write the table (.csv)")->check(given())->type_name("FILE");
}

CLI::Option* add_step(CLI::App* sub, const std::string& name, std::vector<std::string>& values,
                      const std::string& what, const char* type) {
  // One value per mention, so that the order of the steps can be told.
  return sub->add_option(name, values, what)
      ->type_size(1)
      ->expected(1)
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->type_name(type);
}

// The steps in the order of the command line, whatever their options.
std::vector<AffineStep> steps_in_order(const CLI::App& sub) {
  std::vector<AffineStep> steps;
  std::map<const CLI::Option*, std::size_t> used;
  for (const CLI::Option* option : sub.parse_order()) {
    const std::string name = option->get_name();
    if (name != "--matrix" && name != "--scale" && name != "--rotate" && name != "--translate" &&
        name != "--shear") {
      continue;
    }
    steps.push_back({name, option->results().at(used[option]++)});
  }
  return steps;
}

void add_transform(CLI::App& app, Options& options) {
  TransformOptions& o = options.transform;
  CLI::App* sub = command(
      app, options, "transform", Command::kTransform, "Affine map of a mesh or a skeleton; needs no server",
      "  affskel-client transform body.off -o sheared.off --shear y+=z\n"
      "  affskel-client transform body.off -o moved.off --rotate z:30 --scale 2,1,0.5 --translate 0,0,100\n"
      "  affskel-client transform sheared.ply -o back.ply --shear y+=z --inverse\n"
      "Steps are taken in the order given. Normals are mapped as those of planes, E as a volume; H and "
      "other\n"
      "columns stay. A mirrored surface is turned over, so that it stays outward.");
  add_file(sub, "FILE", o.file, "Mesh, surface, skeleton or field: .off .ply .obj .stl .vtp .csv .xyz .dat");
  sub->add_option(
         "-o,--output", o.output,
         "File to write: .off .ply .obj .stl .vtp for triangles,\n.csv .ply .off .xyz .vtp for points")
      ->required()
      ->check(given())
      ->type_name("FILE");
  add_format(sub, o.format);
  // CLI11 wants a place for the values of each option; their order comes from the parse.
  auto values = std::make_shared<std::array<std::vector<std::string>, 5>>();
  add_step(sub, "--matrix", (*values)[0],
           "9 numbers row by row, or 12 with the shift at the end of every row", "A11,A12,...");
  add_step(sub, "--scale", (*values)[1], "One factor or three", "S[,S,S]");
  add_step(sub, "--rotate", (*values)[2],
           "Axis and degrees, as z:30; counter-clockwise seen from the axis' tip", "ROTATION");
  add_step(sub, "--translate", (*values)[3], "Shift", "X,Y,Z");
  add_step(sub, "--shear", (*values)[4], "As y+=z, y+=0.5z or yz:0.5", "SHEAR");
  sub->add_flag("--inverse", o.inverse, "The inverse of the whole");
  sub->callback([sub, &options, values] {
    options.command = Command::kTransform;
    options.transform.steps = steps_in_order(*sub);
  });
}

void add_perturb(CLI::App& app, Options& options) {
  PerturbOptions& o = options.perturb;
  CLI::App* sub = command(app, options, "perturb", Command::kPerturb,
                          "Gaussian noise on the vertices of a mesh; needs no server",
                          "  affskel-client perturb body.off -o noisy.off --noise 0.5% --seed 7\n"
                          "  affskel-client perturb body.off -o noisy.off --sigma 12\n"
                          "Every vertex moves by sigma times a normal number in x, y and z; vertices at one "
                          "place move together.\n"
                          "The same seed gives the same noise on every machine.");
  add_file(sub, "FILE", o.file, "Mesh: .off .ply .obj .stl .vtp");
  sub->add_option("-o,--output", o.output, "File to write: .off .ply .obj .stl .vtp")
      ->required()
      ->check(given())
      ->type_name("FILE");
  add_format(sub, o.format);
  CLI::Option* noise =
      sub->add_option("--noise", o.noise, "Sigma as a share of the box diagonal: 0.5% or 0.005")
          ->check(given())
          ->type_name("SHARE");
  sub->add_option("--sigma", o.sigma, "Sigma in mesh units")
      ->check(positive_number())
      ->excludes(noise)
      ->type_name("S");
  sub->add_option("--seed", o.seed, "Whole number")
      ->check(whole_in(0, ~std::uint64_t{0}))
      ->capture_default_str()
      ->type_name("N");
}

}  // namespace

void add_shape_file_commands(CLI::App& app, Options& options) {
  add_compare(app, options);
  add_transform(app, options);
  add_perturb(app, options);
}

}  // namespace affskel::client
