#include "rows.h"

#include <cmath>
#include <cstdio>

namespace affskel::bench {
namespace {

constexpr MeshSpec kTorus{Shape::kTorus, 256};
constexpr MeshSpec kBall{Shape::kBall, 5120};
constexpr MeshSpec kNoisyBody{Shape::kNoisyBody, 5000};
constexpr MeshSpec kLargestBody{Shape::kBody, 107024};
constexpr MeshSpec kLargeBall{Shape::kBall, 1000000};

constexpr double kPublishedSpacing = 200;

// The largest body's share of directions where all would take minutes: long enough for the bounds to be
// about as tight as its other rows' are.
constexpr std::uint64_t kStretch = 5000;

constexpr MeshSpec body(std::uint32_t triangles) {
  return {Shape::kBody, triangles};
}

RowSpec with_points(const MeshSpec& mesh, std::uint64_t points, std::uint64_t max_directions = 0) {
  RowSpec row;
  row.mesh = mesh;
  row.points = points;
  row.max_directions = max_directions;
  return row;
}

RowSpec published(const MeshSpec& mesh) {
  RowSpec row;
  row.mesh = mesh;
  row.spacing = kPublishedSpacing;
  return row;
}

void add_table(std::vector<RowSpec>& rows, std::uint64_t points) {
  rows.push_back(with_points(kTorus, points));
  for (const std::uint32_t n : {292U, 500U, 1000U, 5000U, 20000U})
    rows.push_back(with_points(body(n), points));
  rows.push_back(with_points(kLargestBody, points, kStretch));
  rows.push_back(with_points(kNoisyBody, points));
  rows.push_back(with_points(kBall, points));
}

void add_growth(std::vector<RowSpec>& rows) {
  for (const std::uint32_t n : {1000U, 5000U, 20000U, 107024U}) {
    rows.push_back(with_points(body(n), 100000, 1000));
    rows.back().section = Section::kGrowthN;
  }
  for (const std::uint64_t points : {100000U, 300000U, 1000000U, 3000000U, 10000000U}) {
    rows.push_back(with_points(body(5000), points, 1000));
    rows.back().section = Section::kGrowthR;
  }
}

std::string power(std::uint64_t value) {
  const double exponent = std::floor(std::log10(static_cast<double>(value)) + 1e-9);
  char text[32];
  std::snprintf(text, sizeof text, "%.3ge%.0f", static_cast<double>(value) / std::pow(10, exponent),
                exponent);
  return text;
}

}  // namespace

std::string mesh_name(const MeshSpec& mesh) {
  const auto named = [&](const char* shape) {
    return std::string(shape) + " " + std::to_string(mesh.triangles);
  };
  switch (mesh.shape) {
    case Shape::kTorus:
      return named("torus");
    case Shape::kNoisyBody:
      return named("noisy body");
    case Shape::kBall:
      return named("ball");
    case Shape::kBody:
      break;
  }
  return named("body");
}

std::string row_name(const RowSpec& row) {
  std::string name = mesh_name(row.mesh) + ", ";
  if (row.spacing > 0) {
    char text[32];
    std::snprintf(text, sizeof text, "dT %g", row.spacing);
    name += text;
  } else {
    name += power(row.points) + " points";
  }
  if (row.directions != "triangles") name += ", " + row.directions;
  if (row.section == Section::kGrowthN) name += ", growth over N";
  if (row.section == Section::kGrowthR) name += ", growth over R";
  if (row.section == Section::kTable && row.mesh == kLargestBody && row.max_directions == 0) {
    name += ", all directions";
  }
  return name;
}

std::vector<RowSpec> rows_of(RowSet set) {
  std::vector<RowSpec> rows{published(kTorus), published(body(292)), published(body(500))};
  if (set == RowSet::kQuick) {
    rows.push_back(with_points(body(1000), 10000));
    rows.push_back(with_points(kBall, 10000));
    rows.push_back(with_points(body(1000), 100000));
    return rows;
  }
  rows.push_back(published(body(5000)));
  add_table(rows, 10000);
  add_table(rows, 100000);
  add_table(rows, 1000000);
  if (set == RowSet::kFull) {
    rows.push_back(with_points(kLargestBody, 100000));
    rows.push_back(with_points(kLargeBall, 1000000));
    rows.back().section = Section::kMemory;
    rows.back().directions = "sphere:200";
  }
  add_growth(rows);
  return rows;
}

}  // namespace affskel::bench
