#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "base/coding.h"
#include "core/mesh/mesh.h"

namespace affskel::tests::samples {

/// Files in formats that the project reads and does not write, made by the formats' rules.

/// Geomview's binary OFF. @param header "OFF", "COFF", ... @param more numbers after each vertex.
std::string binary_off(const core::Mesh& mesh, const std::string& header, unsigned more);

/// Positions and indices of a mesh as glTF has them, each in a view of its own.
struct GltfParts {
  nlohmann::json text;
  std::string binary;
};
GltfParts gltf_parts(const core::Mesh& mesh, std::size_t stride = 12);
std::string glb(const GltfParts& parts);
std::string gltf(GltfParts parts);

/// A zip archive of texts.
std::string archive(const std::vector<std::pair<std::string, std::string>>& texts);
/// A mesh as an object of 3MF.
std::string object_text(const core::Mesh& mesh, const std::string& id);
/// @param attributes of the model, more.
std::string threemf(const std::string& resources, const std::string& items,
                    const std::string& attributes = "");

/// The 24 grey values of the images below, 3 x 4 x 2 voxels.
std::vector<float> grey_values();

template <class Number>
std::string bytes_of(bool big_endian) {
  std::string bytes;
  for (const float value : grey_values()) {
    std::string one;
    base::append(one, static_cast<Number>(value));
    bytes += big_endian ? std::string(one.rbegin(), one.rend()) : one;
  }
  return bytes;
}

/// @param more lines of the header. @param data as `type` and these say.
std::string nrrd(const std::string& type, const std::string& more, const std::string& data);
std::string metaimage(const std::string& type, const std::string& more, const std::string& data);
/// @param affine its place as an affine form; else by a quaternion.
std::string nifti(bool affine, bool big_endian);

}  // namespace affskel::tests::samples
