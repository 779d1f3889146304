#include "derive/messages.h"

namespace affskel::worker {

void append(const core::Vec3& v, google::protobuf::RepeatedField<double>* list) {
  list->Add(v.x);
  list->Add(v.y);
  list->Add(v.z);
}

void append_point(const FinishedField& field, std::uint32_t point, const core::LatticePlace& place,
                  v1::SkeletonPoints& message) {
  const core::FieldValue& value = field.values()[point];
  message.add_point(point);
  append(field.place(place), message.mutable_xyz());
  message.add_erosion(value.erosion);
  append(field.normal(point), message.mutable_normal());
  message.add_direction(value.direction);
}

void append_corners(const core::Mesh& mesh, v1::TriangleMesh& message) {
  message.mutable_corners()->Reserve(static_cast<int>(3 * mesh.triangles.size()));
  for (const core::Triangle& t : mesh.triangles) {
    for (const std::uint32_t v : t) message.add_corners(v);
  }
}

}  // namespace affskel::worker
