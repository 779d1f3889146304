#include "catalogue.h"

#include <stdexcept>

#include "process.h"
#include "tools/files.h"
#include "wire/sha256.h"
#include "wire/words.h"

namespace affskel::chaos {

const std::vector<Recipe>& recipes() {
  static const std::vector<Recipe> all = {
      {"torus", {"torus", "--triangles", "2048"}, 20000, "triangles+sphere:3000", v1::MINIMUM_SET},
      {"body", {"body", "--triangles", "500"}, 20000, "sphere:7000", v1::MINIMUM_SET},
      {"medium", {"body", "--triangles", "300"}, 3000, "sphere:2000", v1::MINIMUM_SET, v1::OPERATOR_FLUX},
      {"tiny", {"torus", "--triangles", "256"}, 2000, "triangles", v1::MINIMUM_SET, v1::OPERATOR_FLUX},
      {"infimum", {"body", "--triangles", "400"}, 5000, "triangles", v1::MINIMUM_INFIMUM},
  };
  return all;
}

Catalogue::Catalogue(const Programs& programs, const std::string& dir) : dir_(dir) {
  for (const Recipe& recipe : recipes()) {
    const std::string path = dir + "/" + recipe.name + ".off";
    Command make{{programs.client, "make"}, "", dir + "/make.log", {}};
    make.arguments.insert(make.arguments.end(), recipe.shape.begin(), recipe.shape.end());
    make.arguments.insert(make.arguments.end(), {"-o", path});
    if (run(make, kPatience) != 0)
      throw std::runtime_error("no mesh: " + tests::read_file(dir + "/make.log"));
    meshes_.push_back(tests::read_file(path));
  }
}

Submission Catalogue::next(std::size_t recipe, const std::string& name) const {
  Submission submission;
  submission.name = name;
  submission.request_id = name;
  const std::string& mesh = meshes_.at(recipe);
  submission.mesh = mesh.substr(0, 4) + "# " + name + "\n" + mesh.substr(4);
  submission.mesh_sha256 = wire::sha256_hex(submission.mesh);
  submission.params.mutable_sampling()->set_target_points(recipes()[recipe].points);
  submission.params.set_directions(recipes()[recipe].directions);
  submission.params.set_minimum(recipes()[recipe].minimum);
  submission.params.set_repair(true);
  submission.skeleton = recipes()[recipe].skeleton;
  submission.recipe = recipe;
  return submission;
}

std::string Catalogue::computed_text(const Programs& programs, std::size_t recipe) const {
  const Recipe& what = recipes()[recipe];
  const std::string stem = dir_ + "/" + what.name;
  const Command compute{
      {programs.worker, "compute", stem + ".off", "--points", std::to_string(what.points), "--directions",
       what.directions, "--minimum", wire::word(what.minimum), "-o", stem + ".csv"},
      "",
      dir_ + "/compute.log",
      {}};
  if (run(compute, kPatience) != 0) {
    throw std::runtime_error("no field: " + tests::read_file(dir_ + "/compute.log"));
  }
  return tests::read_file(stem + ".csv");
}

}  // namespace affskel::chaos
