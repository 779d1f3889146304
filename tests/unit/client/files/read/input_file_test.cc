#include "client/files/read/input_file.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <sstream>
#include <thread>
#include <utility>

#include "base/atomic_file.h"
#include "client/base/error.h"
#include "client/files/format.h"
#include "client/files/read/read_file.h"
#include "client/files/read/read_shape.h"
#include "client/files/write/shape_writer.h"
#include "core/shapes/shapes.h"
#include "tools/files.h"
#include "tools/gzipped.h"
#include "tools/peak_memory.h"
#include "tools/temporary_directory.h"
#include "wire/sha256.h"

namespace affskel::client {
namespace {

ExitCode exit_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const ClientError& error) {
    return error.exit_code();
  }
  return ExitCode::kDone;
}

TEST(ReadFile, ReturnsTheBytesOfFilesAndPipes) {
  const tests::TemporaryDirectory dir;
  std::string bytes(200000, '\0');
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<char>(i * 7);
  tests::write_file(dir / "file", bytes);
  EXPECT_EQ(read_file(dir / "file"), bytes);
  ASSERT_EQ(mkfifo((dir / "pipe").c_str(), 0600), 0);
  std::thread writer([&] { tests::write_file(dir / "pipe", bytes); });
  EXPECT_EQ(read_file(dir / "pipe"), bytes);
  writer.join();
}

TEST(ReadFile, KeepsToItsLimit) {
  const tests::TemporaryDirectory dir;
  tests::write_file(dir / "file", "12345");
  EXPECT_EQ(read_file(dir / "file", 5), "12345");
  EXPECT_EQ(exit_of([&] { read_file(dir / "file", 4); }), ExitCode::kLimit);
  EXPECT_EQ(exit_of([&] { read_file("/dev/zero", 1000); }), ExitCode::kLimit) << "no size to ask for";
}

// Sanitizers need the address space for themselves.
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
void limit_memory(rlim_t bytes) {
  const rlimit limit{bytes, bytes};
  setrlimit(RLIMIT_AS, &limit);
}

TEST(ReadFileDeathTest, WithoutMemoryItNamesTheFile) {
  EXPECT_EXIT(
      {
        limit_memory(rlim_t{1} << 30);
        try {
          read_file("/dev/zero");
        } catch (const ClientError& error) {
          std::fprintf(stderr, "%s\n", error.for_people().c_str());
          _exit(static_cast<int>(error.exit_code()));
        }
        _exit(0);
      },
      ::testing::ExitedWithCode(8), "/dev/zero: not enough memory");
}
#endif

TEST(ReadFile, TakesNoMoreThanTheFileNeeds) {
  const tests::TemporaryDirectory dir;
  tests::write_file(dir / "file", std::string(10000000, 'x'));
  EXPECT_LT(read_file(dir / "file").capacity(), 10100000u);
}

TEST(ReadFile, MissingFilesAndDirectoriesAreBadInput) {
  const tests::TemporaryDirectory dir;
  EXPECT_EQ(exit_of([&] { read_file(dir / "none"); }), ExitCode::kBadInput);
  EXPECT_EQ(exit_of([&] { read_file(dir.path()); }), ExitCode::kBadInput);
}

// The box as the bytes of a format.
std::string bytes_as(FileFormat format, const core::Mesh& mesh) {
  std::string bytes;
  write_surface(format, shape_of(mesh), {}, [&](std::string_view piece) { bytes += piece; });
  return bytes;
}

TEST(ReadInput, MakesOffTextOfOtherFormats) {
  const tests::TemporaryDirectory dir;
  const core::Mesh box = core::make_box(3, 2, 1);
  for (const FileFormat format : {FileFormat::kPly, FileFormat::kObj, FileFormat::kStl}) {
    const std::string path = dir / ("box" + std::string(extension_of(format))), bytes = bytes_as(format, box);
    tests::write_file(path, bytes);
    const InputFile input = read_input(path);
    EXPECT_EQ("." + input.format, extension_of(format));
    EXPECT_TRUE(input.converted());
    EXPECT_EQ(input.file_bytes, bytes.size());
    EXPECT_EQ(input.file_sha256, wire::sha256_hex(bytes));
    // What is submitted is the surface, its corners joined, whatever STL repeats.
    const core::Mesh read = core::read_off(OffText(input).view()).mesh;
    EXPECT_EQ(read.points.size(), 8u) << path;
    EXPECT_EQ(read.triangles.size(), 12u) << path;
    EXPECT_EQ(core::make_solid(read, {false}).volume, 6) << path;
    const Notices notices = conversion_notices(input);
    ASSERT_EQ(notices.size(), 1U);
    EXPECT_EQ(notices[0].file, path);
    EXPECT_NE(notices[0].message.find("8 vertices and 12 triangles"), std::string::npos);
  }
}

TEST(ReadInput, TellsTheUnitOfAFileThatHasOne) {
  InputFile input;
  input.off_text = false;
  input.format = "3mf";
  input.off.unit = "inch";
  const Notices notices = conversion_notices(input);
  ASSERT_EQ(notices.size(), 2U);
  EXPECT_EQ(notices[0].code, "UNIT");
  EXPECT_EQ(notices[0].message, "lengths are in the file's unit, the inch");
}

TEST(ReadInput, KeepsTheBytesOfOffText) {
  const tests::TemporaryDirectory dir;
  const std::string text = "# mine\n" + core::write_off(core::make_box(3, 2, 1));
  for (const char* name : {"box.off", "box", "box.mesh"}) {
    tests::write_file(dir / name, text);
    const InputFile input = read_input(dir / name);
    EXPECT_EQ(input.bytes, text);
    EXPECT_FALSE(input.converted());
    EXPECT_TRUE(conversion_notices(input).empty());
  }
}

// A box whose upper face is bent: half a tetrahedron of its corners lies between the two ways of cutting it.
TEST(ReadInput, TellsOfFacesThatAreNotPlane) {
  const tests::TemporaryDirectory dir;
  const auto box = [](const std::string& corner) {
    return "OFF\n8 6 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n" + corner +
           "\n0 1 1\n4 3 2 1 0\n4 4 5 6 7\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n";
  };
  tests::write_file(dir / "plane.off", box("1 1 1"));
  tests::write_file(dir / "bent.off", box("1 1 1.12"));
  const auto codes = [&](const char* name) {
    const InputFile input = read_input(dir / name);
    return solid_notices(check_solid(input, true), input);
  };
  EXPECT_TRUE(codes("plane.off").empty());
  const Notices told = codes("bent.off");
  ASSERT_EQ(told.size(), 1U);
  EXPECT_EQ(told[0].code, "UNEVEN_POLYGONS");
  EXPECT_NE(told[0].message.find("the worst by 0.0299 (line 12)"), std::string::npos) << told[0].message;
  EXPECT_NE(told[0].message.find("by up to 2 %"), std::string::npos) << told[0].message;
}

TEST(ReadInput, KnowsAFormatByItsContent) {
  const tests::TemporaryDirectory dir;
  const std::string ply = bytes_as(FileFormat::kPly, core::make_box(3, 2, 1));
  tests::write_file(dir / "scan", ply);
  EXPECT_EQ(read_input(dir / "scan").format, "ply");
  tests::write_file(dir / "scan.off", ply);
  EXPECT_EQ(read_input(dir / "scan.off").format, "ply");
  tests::write_file(dir / "scan.STL", ply);
  EXPECT_EQ(read_input(dir / "scan.STL").format, "ply");
  // Packed: the text within is submitted, whatever the name says.
  const std::string text = core::write_off(core::make_box(3, 2, 1));
  tests::write_file(dir / "box.off.gz", tests::gzipped(text));
  const InputFile packed = read_input(dir / "box.off.gz");
  EXPECT_EQ(packed.bytes, text);
  EXPECT_EQ(packed.file_bytes, tests::gzipped(text).size());
  EXPECT_TRUE(packed.converted());
  EXPECT_EQ(job_name(packed.path), "box");
  EXPECT_EQ(conversion_notices(packed).at(0).code, "UNPACKED");
  tests::write_file(dir / "points.csv.gz", tests::gzipped("x,y,z\n1,2,3\n"));
  EXPECT_EQ(read_shape(dir / "points.csv.gz").mesh().points.size(), 1U);
  for (const auto& [name, rows] : {std::pair{"points.obj", "v 0 0 0\nv 1 0 0\n"},
                                   {"points.xyz", "0 0 0\n1 0 0\n"},
                                   {"points.csv", "x,y,z\n0,0,0\n1,0,0\n"}}) {
    tests::write_file(dir / name, rows);
    const InputFile points = read_input(dir / name);
    EXPECT_EQ(points.off.mesh.points.size(), 2U) << name;
    EXPECT_EQ(exit_of([&] { check_solid(points, true); }), ExitCode::kBadInput) << "no triangles";
  }
}

TEST(CheckSolid, RepairsOnlyWhenAllowedAndTellsIt) {
  const tests::TemporaryDirectory dir;
  core::Mesh mesh = core::make_tetrahedron(10);
  std::swap(mesh.triangles[0][0], mesh.triangles[0][1]);
  tests::write_file(dir / "t.off", core::write_off(mesh));
  const InputFile input = read_input(dir / "t.off");
  EXPECT_EQ(exit_of([&] { check_solid(input, false); }), ExitCode::kBadInput);
  const Notices notices = solid_notices(check_solid(input, true), input);
  ASSERT_EQ(notices.size(), 1U);
  EXPECT_EQ(notices[0].kind, Notice::Kind::kNote);
  EXPECT_EQ(notices[0].file, input.path);
  EXPECT_TRUE(notices[0].message.starts_with("repaired: ")) << notices[0].message;
}

TEST(CheckSolid, StopsWhenAsked) {
  struct Stopping : core::ExecutionContext {
    bool stop_requested() override { return true; }
  } context;
  const tests::TemporaryDirectory dir;
  tests::write_file(dir / "t.off", core::write_off(core::make_tetrahedron(10)));
  const InputFile input = read_input(dir / "t.off");
  EXPECT_EQ(exit_of([&] { check_solid(input, true, &context); }), ExitCode::kCancelled);
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
// 0 when reading keeps to its bound.
[[noreturn]] void read_within_bound(const std::string& path) {
  const std::uint64_t before = tests::peak_memory();
  const InputFile input = read_input(path);
  const std::uint64_t taken = tests::peak_memory() - before;
  std::fprintf(stderr, "%ju bytes for %ju\n", std::uintmax_t{taken}, std::uintmax_t{input.file_bytes});
  _exit(taken <= 4 * input.file_bytes + (32U << 20) ? 0 : 1);
}

TEST(ReadInputDeathTest, TakesAtMostFourTimesTheFileAnd32Megabytes) {
  const tests::TemporaryDirectory dir;
  const ShapeFile shape = core::shape_of(core::make_sphere(1000, 1500000));
  for (const char* name : {"a.off", "a.ply", "a.obj", "a.stl", "a.vtp"}) {
    const std::string path = dir / name;
    base::AtomicFile file(path);
    const FileFormat format = choose_format(std::filesystem::path(path), surface_formats(), "mesh");
    write_into(file, [&](const WriteBytes& write) { write_shape(format, shape, {}, write); });
    file.commit();
    EXPECT_EXIT(read_within_bound(path), ::testing::ExitedWithCode(0), "") << name;
  }
}
#endif

// A header that came from elsewhere, an upload say, must not choose a file of this machine.
TEST(ReadNamedInput, TakesTheNumbersOfAnImageFromAFileBesideItsHeader) {
  const tests::TemporaryDirectory dir;
  const std::string header = dir / "ct.mhd";
  tests::write_file(header, "NDims = 3\nDimSize = 4 4 4\nElementType = MET_UCHAR\nElementDataFile = ct.raw");
  core::MeshFileOptions options;
  options.isovalue = 50;
  try {
    read_named_input(header, options);
    FAIL();
  } catch (const ClientError& error) {
    EXPECT_EQ(error.file(), dir / "ct.raw");
    EXPECT_EQ(error.exit_code(), ExitCode::kBadInput);
  }
  std::string values(64, '\0');
  for (const std::size_t at : {21, 22, 25, 26, 37, 38, 41, 42}) values[at] = 'd';
  tests::write_file(dir / "ct.raw", values);
  const InputFile input = read_named_input(header, options);
  EXPECT_EQ(input.format, "voxels");
  EXPECT_FALSE(input.off.mesh.triangles.empty());
  EXPECT_EQ(exit_of([&] { read_input(header, options); }), ExitCode::kBadInput);
}

TEST(PassedOverText, CountsRowsAndObjects) {
  core::OffMesh off;
  off.passed_over = {{"vn", 1, 3}, {"type support", 2, 5, "object"}, {"type other", 1, 7, "object"}};
  EXPECT_EQ(passed_over_text(off),
            "1 row of vn (normals), 2 objects of type support, 1 object of type other");
}

TEST(ReadNamedInput, TellsThatAnImageOfOneValueHasNoSurface) {
  const tests::TemporaryDirectory dir;
  const std::string image = dir / "full.nrrd";
  tests::write_file(image, "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 4 4 4\nencoding: raw\n\n" +
                               std::string(64, '\x07'));
  try {
    read_named_input(image, {});
    FAIL();
  } catch (const ClientError& error) {
    EXPECT_NE(std::string(error.what()).find("all have the value 7: there is no surface"), std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace affskel::client
