// The memory that reading takes, in processes of their own.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdint>
#include <string>

#include "core/files/read/parse_shape.h"
#include "core/shapes/shapes.h"
#include "tools/peak_memory.h"
#include "tools/sample_files.h"

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
namespace affskel::core {
namespace {

using namespace tests::samples;

// 0 when reading takes no more than three times the bytes, which are held once already, and 40 MB: pages of libraries that
// are mapped meanwhile count, too, some megabytes more where the kernel has them in memory.
[[noreturn]] void read_within_bound(const std::string& extension, const std::string& bytes,
                                    const MeshFileOptions& options = {}) {
  const std::uint64_t before = tests::peak_memory();
  const MeshFile file = parse_mesh_file(extension, bytes, options);
  const std::uint64_t taken = tests::peak_memory() - before;
  std::fprintf(stderr, "%ju bytes for %zu\n", std::uintmax_t{taken}, bytes.size());
  _exit(!file.off.mesh.triangles.empty() && taken <= 3 * bytes.size() + (40U << 20) ? 0 : 1);
}

void expect_within_bound(const std::string& extension, const std::string& bytes,
                         const MeshFileOptions& options = {}) {
  EXPECT_EXIT(read_within_bound(extension, bytes, options), ::testing::ExitedWithCode(0), "") << extension;
}

// So large that neither lists of corners beside the file nor a parser's copies of base64 fit.
TEST(ParseMemoryDeathTest, OfGltfIsBounded) {
  const Mesh mesh = make_sphere(1000, 2000000);
  expect_within_bound(".glb", glb(gltf_parts(mesh)));
  expect_within_bound(".gltf", gltf(gltf_parts(mesh)));
}

// Of a large ball, whose surface has more triangles than most of its size.
TEST(ParseMemoryDeathTest, OfImagesIsBounded) {
  constexpr int kSide = 128;
  std::string bytes, words;
  for (int i = 0; i < kSide * kSide * kSide; ++i) {
    const double x = i % kSide - 63.5, y = i / kSide % kSide - 63.5, z = i / kSide / kSide - 63.5;
    bytes += static_cast<char>(std::sqrt(x * x + y * y + z * z) < 60 ? 100 : 0);
    words += bytes.back() != 0 ? "100 " : "0 ";
  }
  const std::string sizes = std::to_string(kSide) + " ";
  const std::string head =
      "NRRD0004\ntype: uchar\ndimension: 3\nsizes: " + sizes + sizes + sizes + "\nencoding: ";
  const MeshFileOptions options{50, {}};
  expect_within_bound(".nrrd", head + "raw\n\n" + bytes, options);
  expect_within_bound(".nrrd", head + "text\n\n" + words, options);
}

}  // namespace
}  // namespace affskel::core
#endif
