// Writes the page.  Lengths in the page are scaled so that the body's box lies about the origin and its
// longest side goes from -1 to 1: "page units".  Numbers are read by client/view/web/decode.js.
#include "client/view/page.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "client/base/error.h"
#include "client/base/mesh_box.h"
#include "client/text/markup_text.h"
#include "client/text/words.h"
#include "client/view/resources.h"
#include "client/view/sheet_pieces.h"
#include "core/files/base64.h"
#include "wire/sha256.h"
#include "wire/version.h"

namespace affskel::client {
namespace {

using core::Vec3;
using nlohmann::ordered_json;

constexpr double kClearlyLonger = 1.25;  // a body's height against its arm span is below
constexpr std::uint16_t kQuantum = 65535;

std::array<double, 3> components(const Vec3& v) {
  return {v.x, v.y, v.z};
}

// From mesh to page units.
struct Scale {
  Vec3 centre;
  double unit = 1;  // mesh units per page unit

  std::array<double, 3> length(const Vec3& v) const { return components((1 / unit) * v); }
  std::array<double, 3> place(const Vec3& v) const { return length(v - centre); }
};

Scale scale_of(const Box& box) {
  return {box.centre(), 0.5 * box.longest_side()};
}

// The arrays of a page, one after the other, each at a multiple of 4 bytes.
class Arrays {
 public:
  // type: u16, u32, f32 or i8.
  template <typename Number>
  void add(const char* name, const char* type, const std::vector<Number>& values) {
    bytes_.resize((bytes_.size() + 3) / 4 * 4);
    directory_[name] = {type, bytes_.size(), values.size()};
    bytes_.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Number));
  }

  const ordered_json& directory() const { return directory_; }
  const std::string& bytes() const { return bytes_; }

 private:
  ordered_json directory_;
  std::string bytes_;
};

// Vertices to 1/65535 of the box, which no screen shows.
ordered_json add_mesh(Arrays& arrays, const core::Mesh& mesh, const Box& box, const Scale& scale) {
  const std::array<double, 3> low = components(box.low), size = components(box.size());
  std::vector<std::uint16_t> steps;
  steps.reserve(3 * mesh.points.size());
  for (const Vec3& point : mesh.points) {
    const std::array<double, 3> at = components(point);
    for (std::size_t a = 0; a < 3; ++a) {
      const double part = size[a] > 0 ? (at[a] - low[a]) / size[a] : 0;
      steps.push_back(static_cast<std::uint16_t>(std::lround(kQuantum * part)));
    }
  }
  std::vector<std::uint32_t> corners;
  corners.reserve(3 * mesh.triangles.size());
  for (const core::Triangle& triangle : mesh.triangles) {
    corners.insert(corners.end(), triangle.begin(), triangle.end());
  }
  arrays.add("meshSteps", "u16", steps);
  if (mesh.points.size() <= kQuantum) {
    arrays.add("meshCorners", "u16", std::vector<std::uint16_t>(corners.begin(), corners.end()));
  } else {
    arrays.add("meshCorners", "u32", corners);
  }
  ordered_json axes = ordered_json::array();
  for (std::size_t a = 0; a < 3; ++a) {
    std::array<double, 3> axis{};
    axis[a] = size[a] / kQuantum / scale.unit;
    axes.push_back(axis);
  }
  return {{"origin", scale.place(box.low)}, {"axes", axes}};
}

std::int8_t quantised(double component) {
  return static_cast<std::int8_t>(std::lround(127 * std::clamp(component, -1.0, 1.0)));
}

ordered_json add_points(Arrays& arrays, const ViewInput& input, const Scale& scale) {
  std::vector<std::uint16_t> steps;
  std::vector<float> shares, divergences;
  std::vector<std::int8_t> inward;
  for (const ViewPoint& point : input.points) {
    steps.insert(steps.end(), point.step.begin(), point.step.end());
    shares.push_back(point.share);
    divergences.push_back(point.divergence);
    for (const double c : components(point.inward)) inward.push_back(quantised(c));
  }
  arrays.add("pointSteps", "u16", steps);
  arrays.add("pointShares", "f32", shares);
  arrays.add("pointDivergences", "f32", divergences);
  arrays.add("pointInward", "i8", inward);
  ordered_json axes = ordered_json::array();
  for (const Vec3& axis : input.grid.axes) axes.push_back(scale.length(axis));
  return {{"origin", scale.place(input.grid.origin)}, {"axes", axes}};
}

void add_sheet(Arrays& arrays, const ViewInput& input, const Scale& scale) {
  const v1::TriangleMesh& sheet = input.sheet;
  std::vector<float> positions, shares;
  for (int v = 0; v < sheet.xyz_size() / 3; ++v) {
    const Vec3 at{sheet.xyz(3 * v), sheet.xyz(3 * v + 1), sheet.xyz(3 * v + 2)};
    for (const double c : scale.place(at)) positions.push_back(static_cast<float>(c));
    shares.push_back(view_share(sheet.erosion(v), input.job.prepared().volume()));
  }
  arrays.add("sheetPositions", "f32", positions);
  arrays.add("sheetShares", "f32", shares);
  arrays.add("sheetCorners", "u32",
             std::vector<std::uint32_t>(sheet.corners().begin(), sheet.corners().end()));
  arrays.add("sheetSegments", "u32",
             std::vector<std::uint32_t>(sheet.segments().begin(), sheet.segments().end()));
  const SheetPieces pieces = sheet_pieces(sheet);
  arrays.add("sheetPieces", "u32", pieces.piece);
  arrays.add("sheetPieceShares", "f32", std::vector<float>(pieces.shares.begin(), pieces.shares.end()));
}

// The steps of the lattice, page units; those of the grid may be several at once.
ordered_json cell_of(const ViewGrid& grid, const Scale& scale) {
  ordered_json cell = ordered_json::array();
  for (std::size_t a = 0; a < 3; ++a)
    cell.push_back(scale.length((1.0 / grid.lattice_steps[a]) * grid.axes[a]));
  return cell;
}

float highest_share(const ViewInput& input) {
  float highest = 0;
  for (const ViewPoint& point : input.points) highest = std::max(highest, point.share);
  return highest;
}

ordered_json facts_of(const ViewInput& input, const Box& box, const Scale& scale) {
  const v1::PreparedSummary& prepared = input.job.prepared();
  const Vec3 size = box.size();
  return {{"name", input.job.name()},
          {"job", input.job.id()},
          {"operator", input.operator_name},
          {"frame", frame_word(input.job.params().frame())},
          {"threshold", input.threshold},
          {"lowestThreshold", input.selection.lowest_threshold},
          {"thinning", input.selection.thinning},
          {"triangles", input.mesh.triangles.size()},
          {"points", prepared.points()},
          {"pointsHere", input.points.size()},
          {"directions", prepared.directions()},
          {"spacing", prepared.spacing()},
          {"volume", prepared.volume()},
          {"highestShare", highest_share(input)},
          {"box", components(size)},
          {"up", std::string(1, up_axis(size))},
          {"unit", scale.unit},
          {"centre", components(scale.centre)},
          {"halfBox", scale.length(0.5 * size)},
          {"cell", cell_of(input.grid, scale)}};
}

// JSON that no HTML parser takes for the end of its element, whatever names it holds.
std::string json_for_html(const ordered_json& value) {
  std::string text;
  for (const char c : value.dump(-1, ' ', true, ordered_json::error_handler_t::replace)) {
    if (c == '<') {
      text += "\\u003c";
    } else if (c == '>') {
      text += "\\u003e";
    } else if (c == '&') {
      text += "\\u0026";
    } else {
      text += c;
    }
  }
  return text;
}

// The template with every {{mark}} replaced; what is put in is not looked at again.
std::string fill(std::string_view text, const std::map<std::string_view, std::string_view>& values) {
  std::string filled;
  for (;;) {
    const std::size_t mark = text.find("{{");
    filled.append(text.substr(0, mark));
    if (mark == std::string_view::npos) return filled;
    const std::size_t end = text.find("}}", mark);
    filled.append(values.at(text.substr(mark + 2, end - mark - 2)));
    text.remove_prefix(end + 2);
  }
}

// As a policy names an inline script or style (CSP Level 3, section 2.3.1).
std::string policy_hash(std::string_view text) {
  const std::string digits = wire::sha256_hex(text);
  std::string bytes;
  for (std::size_t i = 0; i < digits.size(); i += 2)
    bytes += static_cast<char>(std::stoi(digits.substr(i, 2), nullptr, 16));
  return "'sha256-" + core::base64(bytes) + "'";
}

}  // namespace

std::string view_page_policy() {
  const std::string style = std::string(page_overlay_style()) + std::string(page_style());
  return "default-src 'none'; script-src " + policy_hash(page_script()) + "; style-src " +
         policy_hash(style) +
         "; img-src data:; base-uri 'none'; form-action 'none'; frame-ancestors 'self'; sandbox "
         "allow-scripts";
}

char up_axis(const Vec3& box_size) {
  return box_size.y > kClearlyLonger * std::max(box_size.x, box_size.z) ? 'y' : 'z';
}

std::string view_page(const ViewInput& input) {
  if (input.mesh.triangles.empty())
    throw ClientError(ExitCode::kBadInput, "the mesh has no triangles to draw");
  const Box box = mesh_box(input.mesh);
  const Scale scale = scale_of(box);
  Arrays arrays;
  ordered_json facts = facts_of(input, box, scale);
  facts["meshGrid"] = add_mesh(arrays, input.mesh, box, scale);
  facts["pointGrid"] = add_points(arrays, input, scale);
  if (input.sheet_is_skeleton) add_sheet(arrays, input, scale);
  facts["arrays"] = arrays.directory();
  const std::string name = markup_text(input.job.name()), data = json_for_html(facts),
                    block = core::base64(arrays.bytes());
  return fill(page_template(), {{"name", name},
                                {"version", wire::kVersion},
                                {"overlay", page_overlay_style()},
                                {"style", page_style()},
                                {"script", page_script()},
                                {"facts", data},
                                {"arrays", block}});
}

}  // namespace affskel::client
