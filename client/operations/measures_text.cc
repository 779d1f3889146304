#include "client/operations/measures_text.h"

#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "base/number_text.h"
#include "client/text/key_line.h"
#include "client/text/words.h"
#include "core/files/numbers.h"

namespace affskel::client {
namespace {

using nlohmann::ordered_json;

// Of a part; "units" are those of the mesh.  A value that is not there is NaN.
struct MeasureColumn {
  const char* name;
  double (*value)(const v1::SolidPart& part);
};

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

constexpr std::array<MeasureColumn, 17> kMeasureColumns = {{
    {"length_units", [](const v1::SolidPart& p) { return p.length(); }},
    {"straight_length_units", [](const v1::SolidPart& p) { return p.straight_length(); }},
    {"volume_units3", [](const v1::SolidPart& p) { return p.volume(); }},
    {"volume_share", [](const v1::SolidPart& p) { return p.volume_share(); }},
    {"surface_area_units2", [](const v1::SolidPart& p) { return p.surface_area(); }},
    {"mean_radius_units", [](const v1::SolidPart& p) { return p.mean_radius(); }},
    {"least_radius_units", [](const v1::SolidPart& p) { return p.least_radius(); }},
    {"greatest_radius_units", [](const v1::SolidPart& p) { return p.greatest_radius(); }},
    {"angle_degrees", [](const v1::SolidPart& p) { return p.has_angle() ? p.angle() : kNothing; }},
    {"from_x", [](const v1::SolidPart& p) { return p.from(0); }},
    {"from_y", [](const v1::SolidPart& p) { return p.from(1); }},
    {"from_z", [](const v1::SolidPart& p) { return p.from(2); }},
    {"to_x", [](const v1::SolidPart& p) { return p.to(0); }},
    {"to_y", [](const v1::SolidPart& p) { return p.to(1); }},
    {"to_z", [](const v1::SolidPart& p) { return p.to(2); }},
    {"straightness",
     [](const v1::SolidPart& p) { return p.length() > 0 ? p.straight_length() / p.length() : 1; }},
    {"angle_to_part", [](const v1::SolidPart& p) { return p.has_angle_to() ? p.angle_to() : kNothing; }},
}};

ordered_json whole_json(const Measures& m) {
  const v1::SolidParts& solid = m.solid;
  const v1::SkeletonQuality& curve = solid.curve().quality();
  const auto& at = solid.greatest_place();
  return {{"volume_units3", m.job.prepared().volume()},
          {"surface_area_units2", solid.surface_area()},
          {"greatest_E_units3", solid.greatest_erosion()},
          {"greatest_E_place", {at[0], at[1], at[2]}},
          {"sheet_area_units2", solid.sheet_area()},
          {"curve_length_units", m.curve_length},
          {"branches", curve.branches()},
          {"ends", curve.ends()},
          {"pieces", curve.components()},
          {"tunnels", curve.holes()},
          {"voids", curve.lattice().cavities()},
          {"solid_pieces", curve.solid_components()},
          {"solid_tunnels", curve.solid_genus()},
          {"solid_voids", curve.solid_cavities()}};
}

// What is wider still has a space before it.
std::string aligned(std::string text, std::size_t width) {
  text.insert(0, text.size() < width ? width - text.size() : 1, ' ');
  return text;
}

std::string place_text(const google::protobuf::RepeatedField<double>& at) {
  return "(" + base::rounded(at[0], 4) + ", " + base::rounded(at[1], 4) + ", " + base::rounded(at[2], 4) +
         ")";
}

std::string angle_text(const v1::SolidPart& part) {
  return part.has_angle() ? base::rounded(part.angle(), 3) : "-";
}

std::string row_text(int number, const v1::SolidPart& part) {
  const std::string kind = part_kind_word(part.kind());
  std::string text = aligned(std::to_string(number), 5) + "  " + kind +
                     aligned(base::rounded(100 * part.volume_share(), 3), 16 - kind.size());
  for (const double value : {part.volume(), part.surface_area()})
    text += aligned(base::rounded(value, 4), 12);
  for (const double value : {part.length(), part.straight_length(), part.mean_radius(), part.least_radius(),
                             part.greatest_radius()})
    text += aligned(base::rounded(value, 4), 10);
  return text + aligned(angle_text(part), 7) +
         aligned(part.has_angle_to() ? std::to_string(part.angle_to()) : "-", 4) + "  " +
         place_text(part.to()) + "\n";
}

}  // namespace

std::string measures_text(const Measures& m) {
  const v1::SolidParts& solid = m.solid;
  const v1::SkeletonQuality& curve = solid.curve().quality();
  const auto beside = [](std::uint64_t skeleton, std::uint64_t in_solid) {
    return std::to_string(skeleton) + " (solid: " + std::to_string(in_solid) + ")";
  };
  std::string text =
      key_line("volume", base::rounded(m.job.prepared().volume(), 7)) +
      key_line("surface_area", base::rounded(solid.surface_area(), 7)) +
      key_line("greatest_E",
               base::rounded(solid.greatest_erosion(), 7) + " at " + place_text(solid.greatest_place())) +
      key_line("sheet_area", base::rounded(solid.sheet_area(), 5)) +
      key_line("curve_length", base::rounded(m.curve_length, 5)) +
      key_line("pieces", beside(curve.components(), curve.solid_components())) +
      key_line("tunnels", beside(curve.holes(), static_cast<std::uint64_t>(curve.solid_genus()))) +
      key_line("voids", beside(curve.lattice().cavities(), curve.solid_cavities())) +
      key_line("parts", std::to_string(solid.parts_size())) +
      "\n part  kind    volume %      volume        area    length  straight    radius     least  greatest  angle  to"
      "  ends at\n";
  for (int n = 0; n < solid.parts_size(); ++n) text += row_text(n + 1, solid.parts(n));
  return text;
}

std::string measures_csv(const Measures& m) {
  std::string text = "part,kind";
  for (const MeasureColumn& column : kMeasureColumns) text += std::string(",") + column.name;
  text += "\n";
  for (int n = 0; n < m.solid.parts_size(); ++n) {
    const v1::SolidPart& part = m.solid.parts(n);
    text += std::to_string(n + 1) + "," + part_kind_word(part.kind());
    for (const MeasureColumn& column : kMeasureColumns) {
      text.push_back(',');
      if (const double value = column.value(part); std::isfinite(value)) core::append_exact(text, value);
    }
    text += "\n";
  }
  return text;
}

ordered_json measures_json(const Measures& m) {
  ordered_json document{{"job", m.job.id()}, {"whole", whole_json(m)}, {"parts", ordered_json::array()}};
  for (int n = 0; n < m.solid.parts_size(); ++n) {
    const v1::SolidPart& part = m.solid.parts(n);
    ordered_json row{{"part", n + 1}, {"kind", part_kind_word(part.kind())}};
    for (const MeasureColumn& column : kMeasureColumns) row[column.name] = column.value(part);  // NaN: null
    document["parts"].push_back(std::move(row));
  }
  return document;
}

}  // namespace affskel::client
