#pragma once

#include <cstdint>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "client/base/notice.h"
#include "client/base/shape_file.h"
#include "client/files/read/input_file.h"
#include "client/render/curve_plot.h"
#include "core/quality/similarity.h"

namespace affskel::client {

/// What is compared, and how.
struct ComparisonOptions {
  std::string a, b;               ///< files of points or of triangles
  double radius = 0;              ///< as given, squared or not; 0 = the voxel diagonal of the box
  std::vector<double> radii;      ///< >= 0, as given; empty = 0 .. 4 radius
  bool squared = false;           ///< radii are given and shown squared
  std::string solid;              ///< mesh for the chance level; empty = none
  std::uint64_t samples = 50000;  ///< points on a surface
};

/// One side of a comparison.
struct ComparedPoints {
  std::string file;
  bool from_surface = false;       ///< spread over triangles, not the file's own points
  std::vector<core::Vec3> points;  ///< not empty
};

/// Chance level: how near the skeletons the inside of the solid lies anyway.
struct ChanceLevel {
  std::size_t inner_points = 0;
  core::DistanceCurve in_a, in_b;  ///< of the solid's inner points from A and from B
};

/// What `compare` found.  A curve is the share of points within r; its area is taken from 0 to the largest
/// radius.
struct Comparison {
  ComparedPoints a, b;
  core::Similarity curves;
  std::optional<ChanceLevel> chance;
  double radius = 0;          ///< the one that matters: --radius or the voxel diagonal of the box
  bool squared = false;       ///< people read squared radii, as in the published work
  std::vector<double> radii;  ///< ascending, not squared; the last is > 0
  Notices notices;            ///< what was made of the files
};

/// What is done with the files, which may be bounded from outside.
struct FileWork {
  std::function<ShapeFile(const std::string& path)> read;         ///< as read_shape
  std::function<core::Solid(const InputFile& input)> make_solid;  ///< as check_solid with repairs
};

/// Reads and compares.
/// @throws ClientError kUsage for radii that are none, kBadInput for files without points.
Comparison compare_files(const ComparisonOptions& options, const FileWork& work);

/// The table and the summary, for people.
std::string comparison_text(const Comparison& comparison);
/// Header line and one row per radius, 17 significant digits.
std::string comparison_csv(const Comparison& comparison);
nlohmann::ordered_json comparison_json(const Comparison& comparison);
SharePlot comparison_plot(const Comparison& comparison);

}  // namespace affskel::client
