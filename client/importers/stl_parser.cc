#include <cmath>
#include <cstring>

#include "client/importers/shape_parsers.h"
#include "core/perturb.h"
#include "core/text_rows.h"

namespace affskel::client {
namespace {

// STL repeats every corner; equal ones become one vertex, in the order of their first appearance.
ShapeFile joined(const std::vector<core::Vec3>& corners) {
  const std::vector<std::uint32_t> first = core::first_at_same_place(corners);
  ShapeFile file;
  core::Mesh& mesh = file.off.mesh;
  std::vector<std::uint32_t> vertex(corners.size());
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (first[i] == i) {
      vertex[i] = static_cast<std::uint32_t>(mesh.points.size());
      mesh.points.push_back(corners[i]);
    } else {
      vertex[i] = vertex[first[i]];
    }
  }
  for (std::size_t i = 0; i + 2 < corners.size(); i += 3) {
    mesh.triangles.push_back({vertex[i], vertex[i + 1], vertex[i + 2]});
  }
  file.off.polygons = mesh.triangles.size();
  return file;
}

template <typename Number>
Number number_at(std::string_view bytes, std::size_t at) {
  Number value;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

constexpr std::size_t kHeader = 84, kFacet = 50;

ShapeFile parse_binary(std::string_view bytes) {
  std::vector<core::Vec3> corners;
  for (std::size_t at = kHeader; at < bytes.size(); at += kFacet) {
    for (std::size_t c = 0; c < 3; ++c) {
      const auto coordinate = [&](std::size_t k) {
        return double{number_at<float>(bytes, at + 12 + 12 * c + 4 * k)};
      };
      corners.push_back({coordinate(0), coordinate(1), coordinate(2)});
      const core::Vec3& p = corners.back();
      if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) {
        fail_at(0,
                "triangle " + std::to_string((at - kHeader) / kFacet) + " has a corner that is not finite");
      }
    }
  }
  return joined(corners);
}

ShapeFile parse_text(std::string_view bytes) {
  std::vector<core::Vec3> corners;
  core::TextRows rows(bytes);
  std::size_t facet_begin = 0;
  bool ended = false;
  while (rows.next()) {
    const auto& words = rows.words();
    ended = words[0] == "endsolid";
    if (words[0] == "vertex") {
      if (words.size() != 4) fail_at(rows.line(), "a vertex needs three coordinates");
      const auto coordinate = [&](std::size_t i) {
        return core::parse_finite(words[i], rows.line(), "coordinate");
      };
      corners.push_back({coordinate(1), coordinate(2), coordinate(3)});
    } else if (words[0] == "endloop") {
      if (corners.size() - facet_begin != 3) {
        fail_at(rows.line(),
                "a facet of " + std::to_string(corners.size() - facet_begin) + " vertices, needs 3");
      }
      facet_begin = corners.size();
    } else if (words[0] != "solid" && words[0] != "facet" && words[0] != "outer" && words[0] != "endfacet" &&
               !ended) {
      fail_at(rows.line(), "not a row of an STL file: " + core::quoted_piece(rows.text()));
    }
  }
  if (!ended) fail_at(rows.line(), "the file ends before endsolid");
  return joined(corners);
}

}  // namespace

ShapeFile parse_stl(std::string_view bytes) {
  // Some binary files begin with "solid", too; the size tells.
  if (bytes.size() >= kHeader &&
      bytes.size() == kHeader + kFacet * std::size_t{number_at<std::uint32_t>(bytes, 80)}) {
    return parse_binary(bytes);
  }
  if (bytes.starts_with("solid")) return parse_text(bytes);
  fail_at(
      0, "not an STL file: neither text that begins with 'solid' nor as long as its count of triangles says");
}

}  // namespace affskel::client
