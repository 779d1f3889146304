#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "affskel/v1/client_service.pb.h"

namespace affskel::server {

/// The header of a submission, checked and in canonical form.
struct Submission {
  v1::SubmitJobHeader header;  ///< its SHA-256 in lower case
  v1::ErosionParams params;
  v1::SkeletonParams skeleton;
  std::string params_key;
  std::string skeleton_key;
};

/// Checks what a header says by itself.
/// @throws StoreError kInvalid naming field, value and what is allowed; kLimit for a mesh above the limit.
Submission checked_submission(const v1::SubmitJobHeader& header, std::uint64_t max_mesh_bytes);

/// How many bytes follow the header.
std::uint64_t announced_bytes(const v1::SubmitJobHeader& header);

/// The meshes that came with a submission.
struct GivenMeshes {
  std::string_view mesh;
  std::string_view source;  ///< before its repair; empty where it was not repaired
};

/// Parts the bytes that came, and checks them against what the header announced.  @throws StoreError kInvalid.
GivenMeshes checked_meshes(const Submission& submission, std::string_view bytes);

}  // namespace affskel::server
