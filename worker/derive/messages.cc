#include "derive/messages.h"

#include <cctype>

namespace affskel::worker {

void append(const core::Vec3& v, google::protobuf::RepeatedField<double>* list) {
  list->Add(v.x);
  list->Add(v.y);
  list->Add(v.z);
}

void append_point(const FinishedField& field, std::uint32_t point, const core::LatticePlace& place,
                  v1::SkeletonPoints& message) {
  message.add_point(point);
  append(field.place(place), message.mutable_xyz());
  message.add_erosion(field.in_frame().erosion[point]);
  append(field.normal(point), message.mutable_normal());
  if (field.over_set()) message.add_direction(field.optimal()[point]);
}

void append_values(const std::vector<core::PlaceValue>& values, v1::TriangleMesh& message) {
  for (const core::PlaceValue& value : values) {
    message.add_erosion(value.erosion);
    message.add_area(value.area);
  }
}

void append_corners(const core::Mesh& mesh, v1::TriangleMesh& message) {
  message.mutable_corners()->Reserve(static_cast<int>(3 * mesh.triangles.size()));
  for (const core::Triangle& t : mesh.triangles) {
    for (const std::uint32_t v : t) message.add_corners(v);
  }
}

void set_place(const core::Vec3& place, double size, v1::CoarsePlace& message) {
  message.set_x(place.x);
  message.set_y(place.y);
  message.set_z(place.z);
  message.set_size(size);
}

v1::SkeletonQuality quality_message(const core::SkeletonQuality& quality) {
  v1::SkeletonQuality message;
  message.set_points(quality.points);
  message.set_components(quality.skeleton.components);
  message.set_holes(quality.skeleton.holes);
  message.set_cavities(quality.skeleton.cavities);
  message.set_inside_share(quality.inside_share);
  message.set_mean_thickness(quality.mean_thickness);
  message.set_solid_components(quality.solid.components);
  message.set_solid_genus(static_cast<std::int64_t>(quality.solid.holes));
  message.set_solid_cavities(quality.solid.cavities);
  if (quality.hausdorff_there) message.set_hausdorff_there(*quality.hausdorff_there);
  if (quality.hausdorff_back) message.set_hausdorff_back(*quality.hausdorff_back);
  message.set_other_threshold(quality.other_threshold);
  message.set_chance_level(quality.chance_level);
  add_advice(quality.advice, message);
  return message;
}

void add_advice(core::Advice advice, v1::SkeletonQuality& message) {
  if (advice.text.empty()) return;
  if (!message.advice().empty()) {
    advice.text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(advice.text[0])));
    *message.mutable_advice() += ' ';
  }
  *message.mutable_advice() += advice.text;
  for (const core::Setting& setting : advice.settings) {
    v1::Setting& to_try = *message.add_to_try();
    to_try.set_name(setting.name);
    to_try.set_value(setting.value);
  }
}

}  // namespace affskel::worker
