#include "mesh_store.h"

#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <system_error>

#include "core/mesh/box.h"
#include "core/mesh/perturb.h"
#include "core/shapes/body.h"
#include "core/shapes/shapes.h"
#include "core/text/off_file.h"
#include "forked.h"

namespace affskel::bench {
namespace {

// The tube is as thick as spacing 200 needs for about 10,000 points.
constexpr double kTorusMajor = 3000, kTorusMinor = 1200;
constexpr double kBallRadius = 1000;

core::Mesh generate(const MeshSpec& mesh) {
  switch (mesh.shape) {
    case Shape::kTorus:
      return core::make_torus(kTorusMajor, kTorusMinor, mesh.triangles);
    case Shape::kBall:
      return core::make_sphere(kBallRadius, mesh.triangles);
    case Shape::kNoisyBody: {
      const core::Mesh body = core::make_body({mesh.triangles, kBodyUnits});
      return core::perturb(body, {0.01 * core::box_diagonal(body), 1});
    }
    case Shape::kBody:
      break;
  }
  return core::make_body({mesh.triangles, kBodyUnits});
}

void write_file(const std::string& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary);
  file << text;
  if (!file.flush()) throw std::runtime_error(path + ": writing failed");
}

std::filesystem::path make_directory() {
  std::string name = (std::filesystem::temp_directory_path() / "affskel-bench-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) throw std::runtime_error(name + ": " + std::strerror(errno));
  return name;
}

}  // namespace

MeshStore::MeshStore(std::string data_dir) : data_dir_(std::move(data_dir)), directory_(make_directory()) {}

MeshStore::~MeshStore() {
  std::error_code ignored;
  std::filesystem::remove_all(directory_, ignored);
}

std::string MeshStore::real_body(const MeshSpec& mesh) const {
  if (data_dir_.empty() || mesh.shape != Shape::kBody) return "";
  for (const char* stem : {"mh_man_", "mh_man_apose_"}) {
    const std::filesystem::path path =
        std::filesystem::path(data_dir_) / (stem + std::to_string(mesh.triangles) + ".off");
    if (std::filesystem::exists(path)) return path.string();
  }
  return "";
}

std::string MeshStore::source(const MeshSpec& mesh) const {
  const std::string real = real_body(mesh);
  return real.empty() ? "generated" : std::filesystem::path(real).filename().string();
}

const std::string& MeshStore::file(const MeshSpec& mesh) {
  std::string& path = files_[mesh];
  if (!path.empty()) return path;
  const std::string real = real_body(mesh);
  const std::string target =
      real.empty() ? (directory_ / (std::to_string(files_.size()) + ".off")).string() : real;
  if (real.empty()) {
    run_forked([&] {
      write_file(target, core::write_off(generate(mesh)));
      return std::string();
    });
  }
  return path = target;
}

}  // namespace affskel::bench
