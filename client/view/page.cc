// Writes the page.  Lengths in the page are scaled so that each body's box lies about the origin and the
// longest side of all goes from -1 to 1: "page units".  Numbers are read by client/view/web/decode.js.
#include "client/view/page.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "client/artifacts/solid_parts.h"
#include "client/base/colour.h"
#include "client/base/error.h"
#include "client/base/scale_words.h"
#include "client/base/spots.h"
#include "client/text/markup_text.h"
#include "client/text/summary_text.h"
#include "client/text/words.h"
#include "client/view/page_arrays.h"
#include "client/view/resources.h"
#include "client/view/sheet_pieces.h"
#include "core/files/base64.h"
#include "core/mesh/box.h"
#include "wire/sha256.h"
#include "wire/version.h"

namespace affskel::client {
namespace {

using core::Vec3;
using nlohmann::ordered_json;

constexpr std::uint16_t kQuantum = 65535;
constexpr double kSpot = 0.04;  // across, page units

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

// Vertices to 1/65535 of the box, which no screen shows.
std::vector<std::uint16_t> steps_in(const core::Box& box, const std::vector<Vec3>& points) {
  const std::array<double, 3> low = components(box.low), size = components(box.sides());
  std::vector<std::uint16_t> steps;
  steps.reserve(3 * points.size());
  for (const Vec3& point : points) {
    const std::array<double, 3> at = components(point);
    for (std::size_t a = 0; a < 3; ++a) {
      const double part = size[a] > 0 ? std::clamp((at[a] - low[a]) / size[a], 0.0, 1.0) : 0;
      steps.push_back(static_cast<std::uint16_t>(std::lround(kQuantum * part)));
    }
  }
  return steps;
}

void add_corners(PageArrays& arrays, const char* name, const std::vector<std::uint32_t>& corners,
                 std::size_t vertices) {
  if (vertices <= kQuantum) {
    arrays.add(name, "u16", std::vector<std::uint16_t>(corners.begin(), corners.end()));
  } else {
    arrays.add(name, "u32", corners);
  }
}

ordered_json add_mesh(PageArrays& arrays, const core::Mesh& mesh, const core::Box& box, const Scale& scale) {
  std::vector<std::uint32_t> corners;
  corners.reserve(3 * mesh.triangles.size());
  for (const core::Triangle& triangle : mesh.triangles)
    corners.insert(corners.end(), triangle.begin(), triangle.end());
  arrays.add("meshSteps", "u16", steps_in(box, mesh.points));
  add_corners(arrays, "meshCorners", corners, mesh.points.size());
  const std::array<double, 3> size = components(box.sides());
  ordered_json axes = ordered_json::array();
  for (std::size_t a = 0; a < 3; ++a) {
    std::array<double, 3> axis{};
    axis[a] = size[a] / kQuantum / scale.unit;
    axes.push_back(axis);
  }
  return {{"origin", scale.place(box.low)}, {"axes", axes}};
}

// The eroded solids, in the mesh's grid: they lie in it.
ordered_json add_eroded(PageArrays& arrays, const ViewModel& model, const core::Box& box) {
  ordered_json facts = ordered_json::array();
  for (std::size_t level = 0; level < model.eroded.size(); ++level) {
    const v1::TriangleMesh& surface = model.eroded[level];
    std::vector<Vec3> points;
    for (int v = 0; v < surface.xyz_size() / 3; ++v)
      points.push_back({surface.xyz(3 * v), surface.xyz(3 * v + 1), surface.xyz(3 * v + 2)});
    const std::string name = "eroded" + std::to_string(level);
    arrays.add((name + "Steps").c_str(), "u16", steps_in(box, points));
    add_corners(arrays, (name + "Corners").c_str(), {surface.corners().begin(), surface.corners().end()},
                points.size());
    arrays.add((name + "Slopes").c_str(), "f32",
               std::vector<float>(surface.area().begin(), surface.area().end()));
    facts.push_back({{"volume", surface.volume()}, {"triangles", surface.corners_size() / 3}});
  }
  return facts;
}

std::int8_t quantised(double component) {
  return static_cast<std::int8_t>(std::lround(127 * std::clamp(component, -1.0, 1.0)));
}

ordered_json add_points(PageArrays& arrays, const ViewModel& model, const Scale& scale) {
  std::vector<std::uint16_t> steps;
  std::vector<float> shares, divergences, slopes;
  std::vector<std::int8_t> inward;
  for (const ViewPoint& point : model.points) {
    steps.insert(steps.end(), point.step.begin(), point.step.end());
    shares.push_back(point.share);
    divergences.push_back(point.divergence);
    slopes.push_back(point.slope);
    for (const double c : components(point.inward)) inward.push_back(quantised(c));
  }
  arrays.add("pointSteps", "u16", steps);
  arrays.add("pointShares", "f32", shares);
  arrays.add("pointDivergences", "f32", divergences);
  arrays.add("pointSlopes", "f32", slopes);
  arrays.add("pointInward", "i8", inward);
  ordered_json axes = ordered_json::array();
  for (const Vec3& axis : model.grid.axes) axes.push_back(scale.length(axis));
  return {{"origin", scale.place(model.grid.origin)}, {"axes", axes}};
}

using Doubles = google::protobuf::RepeatedField<double>;

std::vector<float> floats(const Doubles& values) {
  return {values.begin(), values.end()};
}

std::vector<std::int8_t> bytes_of(const Doubles& unit_vectors) {
  std::vector<std::int8_t> bytes;
  for (const double c : unit_vectors) bytes.push_back(quantised(c));
  return bytes;
}

// The skeleton, with a segment of no length where it is smaller than the spot that the page draws for that.
v1::TriangleMesh with_spots(v1::TriangleMesh sheet, const Scale& scale) {
  for (const std::uint32_t v : spots_of(sheet, kSpot * scale.unit)) {
    sheet.add_segments(v);
    sheet.add_segments(v);
  }
  return sheet;
}

void add_sheet(PageArrays& arrays, const ViewModel& model, const Scale& scale) {
  const v1::TriangleMesh sheet = with_spots(model.sheet, scale);
  std::vector<float> positions, shares;
  for (int v = 0; v < sheet.xyz_size() / 3; ++v) {
    const Vec3 at{sheet.xyz(3 * v), sheet.xyz(3 * v + 1), sheet.xyz(3 * v + 2)};
    for (const double c : scale.place(at)) positions.push_back(static_cast<float>(c));
    shares.push_back(view_share(sheet.erosion(v), model.job.prepared().volume()));
  }
  arrays.add("sheetPositions", "f32", positions);
  arrays.add("sheetShares", "f32", shares);
  arrays.add("sheetStrengths", "f32", floats(sheet.strength()));
  arrays.add("sheetSlopes", "f32", floats(sheet.area()));
  arrays.add("sheetKinds", "i8", std::vector<std::int8_t>(sheet.kind().begin(), sheet.kind().end()));
  arrays.add("sheetNormalsA", "i8", bytes_of(sheet.normal_a()));
  arrays.add("sheetNormalsB", "i8", bytes_of(sheet.normal_b()));
  arrays.add("sheetCorners", "u32",
             std::vector<std::uint32_t>(sheet.corners().begin(), sheet.corners().end()));
  arrays.add("sheetSegments", "u32",
             std::vector<std::uint32_t>(sheet.segments().begin(), sheet.segments().end()));
  const SheetPieces pieces = sheet_pieces(sheet);
  arrays.add("sheetPieces", "u32", pieces.piece);
  arrays.add("sheetPieceShares", "f32", std::vector<float>(pieces.shares.begin(), pieces.shares.end()));
}

void add_marks(PageArrays& arrays, const ViewModel& model, const Scale& scale) {
  std::vector<float> positions;
  for (const MarkedEdge& edge : model.marks)
    for (const Vec3& end : {edge.from, edge.to})
      for (const double c : scale.place(end)) positions.push_back(static_cast<float>(c));
  arrays.add("markPositions", "f32", positions);
}

// What of the body each triangle is.
ordered_json add_parts(PageArrays& arrays, const v1::SolidParts& solid) {
  ordered_json parts = ordered_json::array();
  if (solid.parts().empty()) return parts;
  arrays.add("meshParts", "u16",
             std::vector<std::uint16_t>(solid.triangle_part().begin(), solid.triangle_part().end()));
  arrays.add("meshThickness", "f32", floats(solid.thickness()));
  const std::vector<Rgb> colours = colours_of(solid);
  for (int p = 0; p < solid.parts_size(); ++p) {
    const v1::SolidPart& part = solid.parts(p);
    const Rgb& colour = colours[static_cast<std::size_t>(p)];
    parts.push_back({{"kind", part_kind_word(part.kind())},
                     {"share", part.volume_share()},
                     {"volume", part.volume()},
                     {"length", part.length()},
                     {"radius", part.mean_radius()},
                     {"colour", {colour.r, colour.g, colour.b}}});
  }
  return parts;
}

// The steps of the lattice, page units; those of the grid may be several at once.
ordered_json cell_of(const ViewGrid& grid, const Scale& scale) {
  ordered_json cell = ordered_json::array();
  for (std::size_t a = 0; a < 3; ++a)
    cell.push_back(scale.length((1.0 / grid.lattice_steps[a]) * grid.axes[a]));
  return cell;
}

// What was repaired, what was found in the mesh and of the lattice, and what the skeleton's quality advises.
ordered_json warnings_of(const ViewModel& model) {
  ordered_json warnings = ordered_json::array();
  for (const v1::RepairStep& step : model.job.repair().steps())
    warnings.push_back(severity_word(step) == "warning" ? step.message() : "repaired: " + step.message());
  for (const v1::MeshNote& note : model.job.prepared().notes()) warnings.push_back(note.message());
  if (model.job.id().empty()) return warnings;
  for (const Notice& warning : skeleton_warnings(model.job.prepared(), model.quality))
    warnings.push_back(warning.message);
  if (!model.quality.advice().empty()) warnings.push_back("the skeleton: " + model.quality.advice());
  return warnings;
}

// How the skeleton hangs together, beside the solid: names and texts.
ordered_json pieces_of(const ViewModel& model) {
  const v1::SkeletonQuality& q = model.quality;
  ordered_json pieces = ordered_json::array();
  if (q.points() == 0) return pieces;
  const auto beside = [&](const char* name, std::uint64_t skeleton, std::uint64_t solid) {
    pieces.push_back({name, std::to_string(skeleton) + " (solid: " + std::to_string(solid) + ")"});
  };
  beside("pieces", q.components(), q.solid_components());
  beside("tunnels", q.holes(), static_cast<std::uint64_t>(q.solid_genus()));
  return pieces;
}

ordered_json facts_of(const ViewModel& model, const core::Box& box, const Scale& scale) {
  const v1::PreparedSummary& prepared = model.job.prepared();
  const Vec3 size = box.sides();
  return {{"name", model.job.name()},
          {"job", model.job.id()},
          {"operator", model.operator_name},
          {"frame", frame_word(model.job.params().frame())},
          {"threshold", model.threshold},
          {"lowestThreshold", model.selection.lowest_threshold},
          {"triangles", prepared.triangles() > 0 ? prepared.triangles() : model.mesh.triangles.size()},
          {"points", prepared.points()},
          {"pointsHere", model.points.size()},
          {"directions", prepared.directions()},
          {"minimum", minimum_word(model.job.params().minimum())},
          {"spacing", prepared.spacing()},
          {"volume", prepared.volume()},
          {"box", components(size)},
          {"centre", components(scale.centre)},
          {"halfBox", scale.length(0.5 * size)},
          {"cell", cell_of(model.grid, scale)},
          {"warnings", warnings_of(model)},
          {"pieces", pieces_of(model)}};
}

// @param unit of all models, mesh units per page unit.
ordered_json add_model(PageArrays& arrays, const ViewModel& model, double unit) {
  arrays.begin_model();
  const core::Box box = core::box_of(model.mesh.points);
  const Scale scale{box.middle(), unit};
  ordered_json facts = facts_of(model, box, scale);
  facts["meshGrid"] = add_mesh(arrays, model.mesh, box, scale);
  facts["pointGrid"] = add_points(arrays, model, scale);
  if (model.sheet_is_skeleton) add_sheet(arrays, model, scale);
  facts["parts"] = add_parts(arrays, model.parts);
  const auto [highest, greatest] = thickness_scale(
      model.mesh, {model.parts.thickness().data(), static_cast<std::size_t>(model.parts.thickness_size())});
  facts["thickness"] = {{"highest", highest}, {"greatest", greatest}};
  add_marks(arrays, model, scale);
  facts["eroded"] = add_eroded(arrays, model, box);
  facts["arrays"] = arrays.directory();
  return facts;
}

ordered_json page_facts(const ViewInput& input, double unit) {
  const core::Stance& stands = input.stance;
  return {{"stands", stance_text(stands)},
          {"stance",
           {{"right", components(stands.right())},
            {"up", components(stands.up.vector())},
            {"front", components(stands.front.vector())}}},
          {"unit", unit},
          {"highestShare", view_share(highest_share(input.models), 1)},
          {"scaleTitle", kScaleTitle},
          {"scaleNote", kScaleNote},
          {"levels", input.levels},
          {"firstLevel", input.first_level},
          {"showLevel", input.show_level},
          {"meshOnly", input.mesh_only}};
}

std::string name_of(const ViewInput& input) {
  std::string name;
  for (const ViewModel& model : input.models) name += (name.empty() ? "" : " and ") + model.job.name();
  return name;
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
  return "default-src 'none'; script-src " + policy_hash(page_script()) + "; style-src " +
         policy_hash(page_style()) +
         "; img-src data:; base-uri 'none'; form-action 'none'; frame-ancestors 'self'; sandbox "
         "allow-scripts allow-downloads";
}

double highest_share(const std::vector<ViewModel>& models) {
  double highest = 0;
  for (const ViewModel& model : models) {
    for (const ViewPoint& point : model.points) {
      if (point.divergence > model.threshold) highest = std::max(highest, double{point.share});
    }
    const double volume = model.job.prepared().volume();
    for (const double e : model.sheet.erosion()) highest = std::max(highest, e / volume);
  }
  return highest;
}

std::string view_page(const ViewInput& input) {
  if (input.models.empty() || input.models.size() > 2)
    throw std::logic_error("a page shows one or two models");
  double longest = 0;
  for (const ViewModel& model : input.models) {
    if (model.mesh.triangles.empty())
      throw ClientError(ExitCode::kBadInput, "the mesh has no triangles to draw");
    longest = std::max(longest, core::box_of(model.mesh.points).longest_side());
  }
  const double unit = 0.5 * longest;
  ordered_json facts = page_facts(input, unit);
  PageArrays arrays;
  for (const ViewModel& model : input.models) facts["models"].push_back(add_model(arrays, model, unit));
  const std::string name = markup_text(name_of(input)), data = json_for_html(facts),
                    block = core::base64(arrays.bytes());
  return fill(page_template(), {{"name", name},
                                {"kind", input.mesh_only ? "Mesh" : "Affine skeleton"},
                                {"what", input.mesh_only ? "mesh" : "affine skeleton"},
                                {"version", wire::kVersion},
                                {"style", page_style()},
                                {"script", page_script()},
                                {"facts", data},
                                {"arrays", block}});
}

}  // namespace affskel::client
