#include "client/artifacts/field_writer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <sstream>

#include "client/base/error.h"
#include "sample_data.h"
#include "tools/files.h"
#include "tools/temporary_directory.h"
#include "wire/refined_record.h"

namespace affskel::client {
namespace {

using core::FileFormat;

constexpr double kVolume = 10;

// Writes the sample field, fed in pieces of `piece` bytes.
void write_sample(FileFormat format, const std::string& path, std::size_t piece) {
  const LatticePoints points(sample_lattice());
  const v1::Directions directions = sample_directions();
  const std::string bytes = sample_field();
  base::AtomicFile file(path);
  FieldWriter writer(format, file, points, kVolume, {});
  FieldDecoder decoder(points, &directions, writer);
  for (std::size_t at = 0; at < bytes.size(); at += piece) {
    decoder.data(std::string_view(bytes).substr(at, piece));
  }
  decoder.finish();
  file.commit();
}

std::vector<std::vector<double>> read_rows(const std::string& text, char separator, bool header) {
  std::vector<std::vector<double>> rows;
  std::istringstream in(text);
  std::string line;
  if (header) std::getline(in, line);
  while (std::getline(in, line)) {
    rows.emplace_back();
    std::istringstream cells(line);
    for (std::string cell; std::getline(cells, cell, separator);)
      rows.back().push_back(std::strtod(cell.c_str(), nullptr));
  }
  return rows;
}

const std::vector<std::array<int, 3>> kPlaces = {{0, 0, 1}, {0, 0, 2}, {0, 1, 3}, {2, 1, 0}, {2, 1, 1}};

void expect_sample(const std::vector<std::vector<double>>& rows, std::size_t columns) {
  ASSERT_EQ(rows.size(), 5u);
  const v1::Directions directions = sample_directions();
  for (std::size_t p = 0; p < 5; ++p) {
    ASSERT_EQ(rows[p].size(), columns);
    const double third = 1.0 / 3;
    EXPECT_EQ(rows[p][0], 0.1 + kPlaces[p][0] * third);
    EXPECT_EQ(rows[p][1], -2.0 + kPlaces[p][1] * third);
    EXPECT_EQ(rows[p][2], 1e6 + kPlaces[p][2] * third);
    EXPECT_EQ(rows[p][3], kSampleErosion[p]);
    for (int c = 0; c < 3; ++c) {
      EXPECT_EQ(rows[p][4 + std::size_t(c)], directions.xyz(3 * int(kSampleDirection[p]) + c));
    }
    if (columns > 7) {
      EXPECT_EQ(rows[p][7], kSampleDirection[p]);
    }
  }
}

TEST(FieldWriter, CsvReadsBackExactlyInLatticeOrder) {
  const tests::TemporaryDirectory dir;
  write_sample(FileFormat::kCsv, dir / "f.csv", 1000);
  const std::string text = tests::read_file(dir / "f.csv");
  EXPECT_EQ(text.substr(0, text.find('\n')), "x,y,z,E,nx,ny,nz,direction");
  expect_sample(read_rows(text, ',', true), 8);
  EXPECT_NE(text.find("0.10000000000000001"), std::string::npos) << "17 significant digits";
}

TEST(FieldWriter, DatHasNoHeaderAndSevenColumns) {
  const tests::TemporaryDirectory dir;
  write_sample(FileFormat::kDat, dir / "f.dat", 1000);
  expect_sample(read_rows(tests::read_file(dir / "f.dat"), ' ', false), 7);
}

TEST(FieldWriter, ARefinedFieldHasItsSlopeAndSaddles) {
  const tests::TemporaryDirectory dir;
  const LatticePoints points(sample_lattice());
  std::string bytes;
  for (std::uint32_t p = 0; p < 5; ++p) {
    wire::RefinedRecord record{
        kSampleErosion[p], 2.5 * p, {0.6, 0, -0.8}, {wire::kNoSaddle, wire::kNoSaddle}, p};
    for (std::uint32_t n = 0; n < std::min(p, 2U); ++n) record.saddles[n] = 7 + n;
    char packed[wire::kRefinedRecordBytes];
    wire::encode_refined_record(packed, record);
    bytes.append(packed, sizeof packed);
  }
  base::AtomicFile file(dir / "a.csv");
  FieldWriter writer(FileFormat::kCsv, file, points, kVolume, {}, {}, true);
  FieldDecoder decoder(points, nullptr, writer);
  for (std::size_t at = 0; at < bytes.size(); at += 7) decoder.data(std::string_view(bytes).substr(at, 7));
  decoder.finish();
  file.commit();
  const std::string text = tests::read_file(dir / "a.csv");
  EXPECT_EQ(text.substr(0, text.find('\n')), "x,y,z,E,nx,ny,nz,slope,saddles");
  const auto rows = read_rows(text, ',', true);
  ASSERT_EQ(rows.size(), 5u);
  for (std::uint32_t p = 0; p < 5; ++p) {
    EXPECT_EQ(std::vector<double>(rows[p].begin() + 3, rows[p].end()),
              (std::vector<double>{kSampleErosion[p], 0.6, 0, -0.8, 2.5 * p, double(std::min(p, 2U))}));
  }
}

TEST(FieldWriter, RecordsMayBeCutAnywhere) {
  const tests::TemporaryDirectory dir;
  write_sample(FileFormat::kCsv, dir / "whole.csv", 1000);
  for (const std::size_t piece : {1u, 7u, 19u, 20u, 21u, 33u}) {
    write_sample(FileFormat::kCsv, dir / "cut.csv", piece);
    EXPECT_EQ(tests::read_file(dir / "cut.csv"), tests::read_file(dir / "whole.csv")) << piece;
  }
}

TEST(FieldWriter, EqualFieldsAreEqualFiles) {
  const tests::TemporaryDirectory dir;
  for (const FileFormat format : core::field_formats()) {
    write_sample(format, dir / "a", 13);
    write_sample(format, dir / "b", 100);
    EXPECT_EQ(tests::read_file(dir / "a"), tests::read_file(dir / "b")) << core::extension_of(format);
  }
}

class DecoderErrors : public ::testing::Test {
 protected:
  void expect_refused(const std::string& bytes) {
    const LatticePoints points(sample_lattice());
    const v1::Directions directions = sample_directions();
    {
      base::AtomicFile file(dir_ / "f.csv");
      FieldWriter writer(FileFormat::kCsv, file, points, kVolume, {});
      FieldDecoder decoder(points, &directions, writer);
      EXPECT_THROW(
          {
            decoder.data(bytes);
            decoder.finish();
          },
          ClientError);
    }
    EXPECT_TRUE(dir_.names().empty());
  }
  tests::TemporaryDirectory dir_;
};

TEST_F(DecoderErrors, TooFewRecords) {
  expect_refused(sample_field().substr(0, 80));
}
TEST_F(DecoderErrors, ARecordCutShort) {
  expect_refused(sample_field().substr(0, 99));
}
TEST_F(DecoderErrors, TooManyRecords) {
  expect_refused(sample_field() + sample_field());
}
TEST_F(DecoderErrors, ADirectionOutOfRange) {
  std::string bytes = sample_field();
  bytes[16] = 2;  // there are two directions, 0 and 1
  expect_refused(bytes);
}

TEST(LatticePoints, RefusesRunsThatLeaveTheirLine) {
  v1::Lattice lattice = sample_lattice();
  lattice.set_run_length(0, 4);  // (0,0,1) .. (0,0,4): nz is 4
  EXPECT_THROW(LatticePoints{lattice}, ClientError);
}

TEST(LatticePoints, RefusesRunsOutOfOrder) {
  v1::Lattice lattice = sample_lattice();
  lattice.set_run_start(1, 2);
  EXPECT_THROW(LatticePoints{lattice}, ClientError);
}

TEST(LatticeCursor, WalksInLatticeOrder) {
  const LatticePoints points(sample_lattice());
  EXPECT_EQ(points.count(), 5u);
  LatticeCursor cursor(points);
  for (const auto& place : kPlaces) {
    ASSERT_FALSE(cursor.at_end());
    EXPECT_EQ(int(cursor.point().i), place[0]);
    EXPECT_EQ(int(cursor.point().j), place[1]);
    EXPECT_EQ(int(cursor.point().k), place[2]);
    cursor.advance();
  }
  EXPECT_TRUE(cursor.at_end());
}

}  // namespace
}  // namespace affskel::client
