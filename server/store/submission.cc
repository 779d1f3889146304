#include "store/submission.h"

#include <algorithm>
#include <stdexcept>

#include "base/quoted.h"
#include "database/errors.h"
#include "wire/params.h"
#include "wire/sha256.h"

namespace affskel::server {
namespace {

constexpr std::size_t kMaxNameBytes = 200;
constexpr std::size_t kMaxOwnerBytes = 100;
constexpr std::size_t kMaxRequestIdBytes = 200;
constexpr std::size_t kMaxDirectionsBytes = 1000;  // kept and sent with every job
constexpr std::uint32_t kMaxPriority = 9;
constexpr std::size_t kSha256Digits = 64;

[[noreturn]] void refuse_submission(const std::string& why) {
  throw StoreError(StoreError::Code::kInvalid, why);
}

void check_size(const char* what, const std::string& text, std::size_t most) {
  if (text.size() <= most) return;
  refuse_submission(std::string(what) + " has " + std::to_string(text.size()) +
                    " bytes, and may have at most " + std::to_string(most));
}

char lower(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

bool is_hex(char c) {
  return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f');
}

std::string checked_sha256(std::string digits) {
  if (digits.empty()) refuse_submission("mesh_sha256 is not set");
  std::transform(digits.begin(), digits.end(), digits.begin(), lower);
  if (digits.size() != kSha256Digits || !std::all_of(digits.begin(), digits.end(), is_hex)) {
    refuse_submission("mesh_sha256 " + base::quoted(digits) +
                      " is no SHA-256: expected 64 hexadecimal digits");
  }
  return digits;
}

void check_header(const v1::SubmitJobHeader& header, std::uint64_t max_mesh_bytes) {
  check_size("the name", header.name(), kMaxNameBytes);
  check_size("the owner", header.owner(), kMaxOwnerBytes);
  check_size("the request id", header.request_id(), kMaxRequestIdBytes);
  check_size("the direction set", header.params().directions(), kMaxDirectionsBytes);
  if (header.priority() > kMaxPriority) {
    refuse_submission("the priority must be 0 .. 9, not " + std::to_string(header.priority()));
  }
  if (header.mesh_bytes() == 0) {
    refuse_submission("mesh_bytes is 0 or not set: it is the size of the mesh file, which must not be empty");
  }
  if (header.mesh_bytes() > max_mesh_bytes) {
    throw StoreError(StoreError::Code::kLimit, "the mesh has " + std::to_string(header.mesh_bytes()) +
                                                   " bytes; this server takes at most " +
                                                   std::to_string(max_mesh_bytes));
  }
}

}  // namespace

Submission checked_submission(const v1::SubmitJobHeader& header, std::uint64_t max_mesh_bytes) {
  check_header(header, max_mesh_bytes);
  Submission submission;
  submission.header = header;
  submission.header.set_mesh_sha256(checked_sha256(header.mesh_sha256()));
  try {
    submission.params = wire::canonical(header.params());
    submission.skeleton = wire::canonical(header.skeleton());
  } catch (const std::invalid_argument& error) {
    refuse_submission(error.what());
  }
  submission.params_key = wire::cache_key(submission.params);
  submission.skeleton_key = wire::cache_key(submission.skeleton);
  return submission;
}

void check_mesh(const Submission& submission, std::string_view mesh) {
  const v1::SubmitJobHeader& header = submission.header;
  if (header.mesh_bytes() != mesh.size()) {
    refuse_submission("mesh_bytes announced " + std::to_string(header.mesh_bytes()) + " bytes, but " +
                      std::to_string(mesh.size()) + " arrived");
  }
  if (const std::string sha256 = wire::sha256_hex(mesh); sha256 != header.mesh_sha256()) {
    refuse_submission("the mesh that arrived has the SHA-256 " + sha256 + ", not the announced mesh_sha256 " +
                      header.mesh_sha256());
  }
}

}  // namespace affskel::server
