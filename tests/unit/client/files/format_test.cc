#include "client/files/format.h"

#include <gtest/gtest.h>

#include "client/base/error.h"
#include "tools/temporary_directory.h"

namespace affskel::client {
namespace {

TEST(ChooseFormat, FollowsTheExtensionInAnyCase) {
  EXPECT_EQ(choose_format("a/b.vtkhdf", field_formats(), "field"), FileFormat::kVtkHdf);
  EXPECT_EQ(choose_format("x.y.CSV", skeleton_formats(), "skeleton"), FileFormat::kCsv);
  EXPECT_EQ(choose_format("x.Stl", surface_formats(), "surface"), FileFormat::kStl);
  EXPECT_EQ(lower_extension("A.b/C.OFF"), ".off");
  EXPECT_EQ(lower_extension("A.b/C"), "");
}

TEST(ChooseFormat, NamesThePossibleOnes) {
  for (const char* name : {"x.stl", "x", "csv", ".csv"}) {
    try {
      choose_format(name, field_formats(), "field");
      FAIL() << name;
    } catch (const ClientError& error) {
      EXPECT_EQ(error.exit_code(), ExitCode::kUsage);
      EXPECT_NE(std::string(error.what()).find(".csv, .dat, .vti, .vts, .vtkhdf, .hdf"), std::string::npos)
          << error.what();
    }
  }
}

TEST(ChooseFormat, AFormatStandsAboveTheName) {
  for (const char* format : {"ply", ".PLY", "Ply"}) {
    EXPECT_EQ(choose_format(Destination{"x.csv", format}, skeleton_formats(), "skeleton"), FileFormat::kPly);
    EXPECT_EQ(choose_format(Destination{"-", format}, skeleton_formats(), "skeleton"), FileFormat::kPly);
  }
  EXPECT_EQ(choose_format(Destination{"x.csv"}, skeleton_formats(), "skeleton"), FileFormat::kCsv);
  EXPECT_EQ(choose_format(Destination{"-"}, picture_formats(), "picture"), FileFormat::kPng);
  for (const Destination& wrong :
       {Destination{"-"}, Destination{"x.csv", "png"}, Destination{"x.csv", "."}}) {
    EXPECT_THROW(choose_format(wrong, skeleton_formats(), "skeleton"), ClientError) << wrong.format;
  }
  try {
    choose_format(Destination{"-"}, skeleton_formats(), "skeleton");
  } catch (const ClientError& error) {
    EXPECT_EQ(error.for_people(),
              "standard output: a format is needed for the skeleton; possible are .csv, .ply, .off, "
              ".xyz, .vtp");
  }
}

TEST(ChooseFormat, ToldOfAFolderAsksForAFile) {
  const tests::TemporaryDirectory present;
  for (const std::string& folder : {std::string("results/"), present.path().string()}) {
    try {
      choose_format(folder, field_formats(), "field");
      FAIL() << folder;
    } catch (const ClientError& error) {
      EXPECT_NE(std::string(error.what()).find("is a folder; name a file in it for the field; possible"),
                std::string::npos)
          << error.what();
    }
  }
}

TEST(ChooseFormat, SpeaksOfWhatIsToBeWritten) {
  try {
    choose_format("e.STL", skeleton_formats(), "eroded solid's points");
    FAIL();
  } catch (const ClientError& error) {
    EXPECT_STREQ(
        error.what(),
        "cannot write the eroded solid's points as '.stl'; possible are .csv, .ply, .off, .xyz, .vtp");
  }
}

}  // namespace
}  // namespace affskel::client
