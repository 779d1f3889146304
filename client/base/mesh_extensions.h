#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>

namespace affskel::client {

/// Extensions of the files that a mesh is read from, see core::parse_mesh_file; the first is Geomview OFF's.
inline constexpr std::array<std::string_view, 8> kMeshExtensions = {".off", ".ply", ".obj",  ".stl",
                                                                    ".vtp", ".glb", ".gltf", ".3mf"};
/// Those of images of voxels, at whose surface a mesh is made.
inline constexpr std::array<std::string_view, 5> kVoxelExtensions = {".nrrd", ".nhdr", ".mha", ".mhd",
                                                                     ".nii"};
/// What a compressed one has behind its own, see core::unpack.
inline constexpr std::array<std::string_view, 2> kPackedExtensions = {".gz", ".zst"};

/// Each behind a blank.
inline std::string listed(std::span<const std::string_view> extensions) {
  std::string text;
  for (const std::string_view extension : extensions) text += " " + std::string(extension);
  return text;
}

}  // namespace affskel::client
