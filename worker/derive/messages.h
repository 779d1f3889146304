#pragma once

#include <cstddef>
#include <vector>

#include "affskel/v1/types.pb.h"
#include "core/erosion/field_between.h"
#include "core/mesh/mesh.h"
#include "core/quality/skeleton_quality.h"
#include "derive/finished_field.h"

namespace affskel::worker {

/// Appends x, y, z.
void append(const core::Vec3& v, google::protobuf::RepeatedField<double>* list);

/// Appends a sample point with E, optimal normal and direction.
void append_point(const FinishedField& field, std::uint32_t point, const core::LatticePlace& place,
                  v1::SkeletonPoints& message);

/// Appends E and area per vertex.
void append_values(const std::vector<core::PlaceValue>& values, v1::TriangleMesh& message);

void append_corners(const core::Mesh& mesh, v1::TriangleMesh& message);

/// Of one kind no more places are named.
inline constexpr std::size_t kMaxPlaces = 8;

/// @param place in mesh coordinates.
void set_place(const core::Vec3& place, double size, v1::CoarsePlace& message);

v1::SkeletonQuality quality_message(const core::SkeletonQuality& quality);

/// Adds its sentences and settings to those that the message has; nothing of one without text.
void add_advice(core::Advice advice, v1::SkeletonQuality& message);

}  // namespace affskel::worker
