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
// The report of a repair is kept and sent with every job: 32 KB at most.
constexpr int kMaxRepairSteps = 30;
constexpr std::size_t kMaxStepCodeBytes = 60;
constexpr std::size_t kMaxStepMessageBytes = 1000;

[[noreturn]] void refuse_submission(const std::string& why) {
  throw StoreError(StoreError::Code::kInvalid, why);
}

void check_size(const char* what, const std::string& text, std::size_t most) {
  if (text.size() <= most) return;
  refuse_submission(std::string(what) + " has " + std::to_string(text.size()) +
                    " bytes, and may have at most " + std::to_string(most));
}

/// In UTF-8: those from U+0080 on have two bytes.
bool has_control(const std::string& text) {
  unsigned char before = 0;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < ' ' || byte == 0x7F || (before == 0xC2 && byte < 0xA0)) return true;
    before = byte;
  }
  return false;
}

/// What a line on a screen has no place for.
void check_seen(const char* what, const std::string& text) {
  if (has_control(text))
    refuse_submission(std::string(what) + " " + base::quoted(text) + " has a control character");
}

char lower(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

bool is_hex(char c) {
  return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f');
}

std::string checked_sha256(const char* what, std::string digits) {
  if (digits.empty()) refuse_submission(std::string(what) + " is not set");
  std::transform(digits.begin(), digits.end(), digits.begin(), lower);
  if (digits.size() != kSha256Digits || !std::all_of(digits.begin(), digits.end(), is_hex)) {
    refuse_submission(std::string(what) + " " + base::quoted(digits) +
                      " is no SHA-256: expected 64 hexadecimal digits");
  }
  return digits;
}

/// @param what the field. @param mesh "the mesh".
void check_mesh_size(const char* what, const char* mesh, std::uint64_t bytes, std::uint64_t most) {
  if (bytes == 0) {
    refuse_submission(std::string(what) +
                      " is 0 or not set: it is the size of the mesh file, which must not be empty");
  }
  if (bytes > most) {
    throw StoreError(StoreError::Code::kLimit, std::string(mesh) + " has " + std::to_string(bytes) +
                                                   " bytes; this server takes at most " +
                                                   std::to_string(most));
  }
}

void check_repair(const v1::MeshRepair& repair, std::uint64_t max_mesh_bytes) {
  check_mesh_size("source_bytes", "the mesh before its repair", repair.source_bytes(), max_mesh_bytes);
  if (repair.steps().empty()) refuse_submission("a repair has at least one step");
  if (repair.steps_size() > kMaxRepairSteps) {
    refuse_submission("the repair has " + std::to_string(repair.steps_size()) +
                      " steps, and may have at most " + std::to_string(kMaxRepairSteps));
  }
  for (const v1::RepairStep& step : repair.steps()) {
    if (step.code().empty()) refuse_submission("a step of the repair has no code");
    check_size("a step's code", step.code(), kMaxStepCodeBytes);
    check_size("a step's message", step.message(), kMaxStepMessageBytes);
    if (step.severity() != "" && step.severity() != "repaired" && step.severity() != "warning")
      refuse_submission("a step's severity is \"repaired\" or \"warning\", not " +
                        base::quoted(step.severity()));
  }
}

void check_header(const v1::SubmitJobHeader& header, std::uint64_t max_mesh_bytes) {
  check_size("the name", header.name(), kMaxNameBytes);
  check_seen("the name", header.name());
  check_size("the owner", header.owner(), kMaxOwnerBytes);
  check_size("the request id", header.request_id(), kMaxRequestIdBytes);
  check_size("the direction set", header.params().directions(), kMaxDirectionsBytes);
  if (header.priority() > kMaxPriority) {
    refuse_submission("the priority must be 0 .. 9, not " + std::to_string(header.priority()));
  }
  check_mesh_size("mesh_bytes", "the mesh", header.mesh_bytes(), max_mesh_bytes);
  if (header.has_repair()) check_repair(header.repair(), max_mesh_bytes);
}

void require_sha256(const char* mesh, const char* field, std::string_view bytes,
                    const std::string& announced) {
  const std::string sha256 = wire::sha256_hex(bytes);
  if (sha256 == announced) return;
  refuse_submission("the " + std::string(mesh) + " that arrived has the SHA-256 " + sha256 +
                    ", not the announced " + field + " " + announced);
}

}  // namespace

Submission checked_submission(const v1::SubmitJobHeader& header, std::uint64_t max_mesh_bytes) {
  check_header(header, max_mesh_bytes);
  Submission submission;
  submission.header = header;
  submission.header.set_mesh_sha256(checked_sha256("mesh_sha256", header.mesh_sha256()));
  if (header.has_repair()) {
    submission.header.mutable_repair()->set_source_sha256(
        checked_sha256("source_sha256", header.repair().source_sha256()));
  }
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

std::uint64_t announced_bytes(const v1::SubmitJobHeader& header) {
  return header.mesh_bytes() + header.repair().source_bytes();
}

GivenMeshes checked_meshes(const Submission& submission, std::string_view bytes) {
  const v1::SubmitJobHeader& header = submission.header;
  if (announced_bytes(header) != bytes.size()) {
    const bool two = header.has_repair();
    refuse_submission(std::string(two ? "mesh_bytes and source_bytes" : "mesh_bytes") + " announced " +
                      std::to_string(announced_bytes(header)) + " bytes, but " +
                      std::to_string(bytes.size()) + " arrived");
  }
  const GivenMeshes meshes = {bytes.substr(0, header.mesh_bytes()), bytes.substr(header.mesh_bytes())};
  require_sha256("mesh", "mesh_sha256", meshes.mesh, header.mesh_sha256());
  if (header.has_repair()) {
    require_sha256("mesh before its repair", "source_sha256", meshes.source, header.repair().source_sha256());
  }
  return meshes;
}

}  // namespace affskel::server
