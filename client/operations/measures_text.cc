#include "client/operations/measures_text.h"

#include <array>
#include <nlohmann/json.hpp>

#include "base/number_text.h"
#include "client/text/key_line.h"
#include "core/files/numbers.h"

namespace affskel::client {
namespace {

using nlohmann::ordered_json;

// Of a part; "units" are those of the mesh.
struct MeasureColumn {
  const char* name;
  double (*value)(const MeasuredPart& part);
};

constexpr std::array<MeasureColumn, 14> kMeasureColumns = {{
    {"length_units", [](const MeasuredPart& p) { return p.length; }},
    {"straight_length_units", [](const MeasuredPart& p) { return p.straight_length; }},
    {"volume_units3", [](const MeasuredPart& p) { return p.volume; }},
    {"volume_share", [](const MeasuredPart& p) { return p.volume_share; }},
    {"mean_radius_units", [](const MeasuredPart& p) { return p.mean_radius; }},
    {"least_radius_units", [](const MeasuredPart& p) { return p.least_radius; }},
    {"greatest_radius_units", [](const MeasuredPart& p) { return p.greatest_radius; }},
    {"from_x", [](const MeasuredPart& p) { return p.from.x; }},
    {"from_y", [](const MeasuredPart& p) { return p.from.y; }},
    {"from_z", [](const MeasuredPart& p) { return p.from.z; }},
    {"to_x", [](const MeasuredPart& p) { return p.to.x; }},
    {"to_y", [](const MeasuredPart& p) { return p.to.y; }},
    {"to_z", [](const MeasuredPart& p) { return p.to.z; }},
    {"straightness", [](const MeasuredPart& p) { return p.length > 0 ? p.straight_length / p.length : 1; }},
}};

ordered_json whole_json(const Measures& m) {
  return {{"volume_units3", m.volume},
          {"surface_area_units2", m.surface_area},
          {"curve_length_units", m.curve_length},
          {"branches", m.parts.size()},
          {"ends", m.curve.ends()},
          {"pieces", m.curve.components()},
          {"tunnels", m.curve.holes()},
          {"solid_pieces", m.curve.solid_components()},
          {"solid_tunnels", m.curve.solid_genus()},
          {"solid_voids", m.curve.solid_cavities()}};
}

std::string aligned(std::string text, std::size_t width) {
  if (text.size() < width) text.insert(0, width - text.size(), ' ');
  return text;
}

std::string place_text(const core::Vec3& at) {
  return "(" + base::rounded(at.x, 4) + ", " + base::rounded(at.y, 4) + ", " + base::rounded(at.z, 4) + ")";
}

}  // namespace

std::string measures_text(const Measures& m) {
  std::string text = key_line("volume", base::rounded(m.volume, 7)) +
                     key_line("surface_area", base::rounded(m.surface_area, 7)) +
                     key_line("curve_length", base::rounded(m.curve_length, 5)) +
                     key_line("pieces", std::to_string(m.curve.components()) +
                                            " (solid: " + std::to_string(m.curve.solid_components()) + ")") +
                     key_line("tunnels", std::to_string(m.curve.holes()) +
                                             " (solid: " + std::to_string(m.curve.solid_genus()) + ")") +
                     key_line("parts", std::to_string(m.parts.size()));
  if (m.parts.empty()) return text;
  text +=
      "\n part  kind    volume %      volume    length  straight    radius     least  greatest  ends at\n";
  for (std::size_t n = 0; n < m.parts.size(); ++n) {
    const MeasuredPart& part = m.parts[n];
    text += aligned(std::to_string(n + 1), 5) + "  " + part.kind +
            aligned(base::rounded(100 * part.volume_share, 3), 12) +
            aligned(base::rounded(part.volume, 4), 12);
    for (const double value :
         {part.length, part.straight_length, part.mean_radius, part.least_radius, part.greatest_radius})
      text += aligned(base::rounded(value, 4), 10);
    text += "  " + place_text(part.to) + "\n";
  }
  return text;
}

std::string measures_csv(const Measures& m) {
  std::string text = "part,kind";
  for (const MeasureColumn& column : kMeasureColumns) text += std::string(",") + column.name;
  text += "\n";
  for (std::size_t n = 0; n < m.parts.size(); ++n) {
    text += std::to_string(n + 1) + "," + m.parts[n].kind;
    for (const MeasureColumn& column : kMeasureColumns) {
      text.push_back(',');
      core::append_exact(text, column.value(m.parts[n]));
    }
    text += "\n";
  }
  return text;
}

ordered_json measures_json(const Measures& m) {
  ordered_json document{{"job", m.job.id()}, {"whole", whole_json(m)}, {"parts", ordered_json::array()}};
  for (std::size_t n = 0; n < m.parts.size(); ++n) {
    ordered_json part{{"part", n + 1}, {"kind", m.parts[n].kind}};
    for (const MeasureColumn& column : kMeasureColumns) part[column.name] = column.value(m.parts[n]);
    document["parts"].push_back(std::move(part));
  }
  return document;
}

}  // namespace affskel::client
