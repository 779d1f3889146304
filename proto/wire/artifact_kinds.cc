#include "wire/artifact_kinds.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <vector>

#include "wire/params.h"
#include "wire/words.h"

namespace affskel::wire {
namespace {

using P = ArtifactParams;

constexpr std::string_view kPoints = "affskel.v1.SkeletonPoints";
constexpr std::string_view kMesh = "affskel.v1.TriangleMesh";

constexpr std::array<ArtifactKindInfo, 12> kKinds = {{
    {v1::ARTIFACT_KIND_MESH, P::kNone, v1::TASK_KIND_UNSPECIFIED, ""},
    {v1::ARTIFACT_KIND_LATTICE, P::kNone, v1::TASK_KIND_PREPARE, "affskel.v1.Lattice"},
    {v1::ARTIFACT_KIND_DIRECTIONS, P::kNone, v1::TASK_KIND_PREPARE, "affskel.v1.Directions"},
    {v1::ARTIFACT_KIND_FIELD, P::kNone, v1::TASK_KIND_ERODE, ""},
    {v1::ARTIFACT_KIND_SKELETON, P::kSkeleton, v1::TASK_KIND_SKELETON, kPoints},
    {v1::ARTIFACT_KIND_SURFACE, P::kSurface, v1::TASK_KIND_SURFACE, kMesh},
    {v1::ARTIFACT_KIND_DIVERGENCE, P::kOperator, v1::TASK_KIND_DIVERGENCE, ""},
    {v1::ARTIFACT_KIND_ERODED_POINTS, P::kEroded, v1::TASK_KIND_ERODED_POINTS, kPoints},
    {v1::ARTIFACT_KIND_ERODED_SURFACE, P::kEroded, v1::TASK_KIND_ERODED_SURFACE, kMesh},
    {v1::ARTIFACT_KIND_PARTS, P::kCurve, v1::TASK_KIND_PARTS, "affskel.v1.SolidParts"},
    {v1::ARTIFACT_KIND_REFINED, P::kNone, v1::TASK_KIND_REFINE, ""},
    {v1::ARTIFACT_KIND_SOURCE, P::kNone, v1::TASK_KIND_UNSPECIFIED, ""},
}};
static_assert(kKinds.size() == v1::ArtifactKind_ARRAYSIZE - 1, "every kind but UNSPECIFIED has a row");

template <typename Params>
CanonicalParams packed(const Params& params) {
  return {params.SerializeAsString(), cache_key(params)};
}

v1::SkeletonParams curve_params(const v1::FetchArtifactRequest& request) {
  v1::SkeletonParams curve = request.skeleton();
  if (curve.operator_() == v1::OPERATOR_UNSPECIFIED) curve.set_operator_(v1::OPERATOR_CURVE);
  if (curve.operator_() != v1::OPERATOR_CURVE)
    throw std::invalid_argument("parts are those of the operator curve");
  return canonical(curve);
}

v1::SkeletonParams usual_divergence(const v1::SkeletonParams& job_skeleton) {
  v1::SkeletonParams usual;
  usual.set_operator_(wire::usual_divergence(job_skeleton.operator_()));
  return usual;
}

/// One of the messages with parameters in a request.
struct Given {
  bool given;
  std::string_view name;
  std::array<ArtifactParams, 3> for_kinds_with;
  std::string_view hint;
};

std::string kinds_with(const Given& params) {
  std::vector<std::string> names;
  for (const ArtifactKindInfo& row : kKinds) {
    if (std::ranges::find(params.for_kinds_with, row.params) == params.for_kinds_with.end()) continue;
    names.push_back(v1::ArtifactKind_Name(row.kind).substr(std::string("ARTIFACT_KIND_").size()));
  }
  std::string text = names.front();
  for (std::size_t n = 1; n < names.size(); ++n) text += (n + 1 < names.size() ? ", " : " and ") + names[n];
  return text;
}

}  // namespace

bool ArtifactKindInfo::derived() const {
  return params != ArtifactParams::kNone;
}

std::string ArtifactKindInfo::name() const {
  return word(kind);
}

std::span<const ArtifactKindInfo> artifact_kinds() {
  return kKinds;
}

const ArtifactKindInfo* find_artifact_kind(v1::ArtifactKind kind) {
  const auto row = std::ranges::find(kKinds, kind, &ArtifactKindInfo::kind);
  return row == kKinds.end() ? nullptr : &*row;
}

const ArtifactKindInfo* find_derived_kind(v1::TaskKind task) {
  const auto row = std::ranges::find_if(
      kKinds, [&](const ArtifactKindInfo& info) { return info.derived() && info.task == task; });
  return row == kKinds.end() ? nullptr : &*row;
}

const ArtifactKindInfo& own_skeleton_kind(v1::Operator of_job) {
  return *find_artifact_kind(gives_sheet(of_job) ? v1::ARTIFACT_KIND_SURFACE : v1::ARTIFACT_KIND_SKELETON);
}

CanonicalParams artifact_params(const ArtifactKindInfo& kind, const v1::FetchArtifactRequest& request,
                                const v1::SkeletonParams& job_skeleton) {
  const v1::SkeletonParams skeleton = request.has_skeleton() ? canonical(request.skeleton()) : job_skeleton;
  switch (kind.params) {
    case ArtifactParams::kNone:
      return {};
    case ArtifactParams::kSkeleton:
      return packed(skeleton);
    case ArtifactParams::kOperator:
      return packed(divergence_params(request.skeleton().operator_() == v1::OPERATOR_UNSPECIFIED
                                          ? usual_divergence(job_skeleton)
                                          : skeleton));
    case ArtifactParams::kSurface: {
      v1::SurfaceParams surface = request.surface();
      if (!surface.has_skeleton()) *surface.mutable_skeleton() = job_skeleton;
      return packed(canonical(surface));
    }
    case ArtifactParams::kEroded:
      return packed(canonical(request.eroded()));
    case ArtifactParams::kCurve:
      return packed(curve_params(request));
  }
  throw std::logic_error("parameters of an unknown kind");
}

void check_request(const v1::FetchArtifactRequest& request) {
  const ArtifactKindInfo* row = find_artifact_kind(request.kind());
  if (row == nullptr) {
    throw std::invalid_argument("unknown kind of artefact: " +
                                std::to_string(static_cast<int>(request.kind())));
  }
  const std::array<Given, 3> all = {{
      {request.has_skeleton(),
       "skeleton",
       {P::kSkeleton, P::kOperator, P::kCurve},
       " (SURFACE has surface.skeleton)"},
      {request.has_surface(), "surface", {P::kSurface, P::kSurface, P::kSurface}, ""},
      {request.has_eroded(), "eroded", {P::kEroded, P::kEroded, P::kEroded}, ""},
  }};
  for (const Given& params : all) {
    if (!params.given ||
        std::ranges::find(params.for_kinds_with, row->params) != params.for_kinds_with.end()) {
      continue;
    }
    throw std::invalid_argument("the parameters '" + std::string(params.name) + "' are for " +
                                kinds_with(params) + std::string(params.hint) + ", not for " +
                                v1::ArtifactKind_Name(request.kind()));
  }
}

bool set_task_params(ArtifactParams params, const std::string& bytes, v1::Lease& lease) {
  switch (params) {
    case ArtifactParams::kNone:
      return bytes.empty();
    case ArtifactParams::kSkeleton:
    case ArtifactParams::kOperator:
    case ArtifactParams::kCurve:
      return lease.mutable_skeleton()->ParseFromString(bytes);
    case ArtifactParams::kSurface:
      return lease.mutable_surface()->ParseFromString(bytes);
    case ArtifactParams::kEroded:
      return lease.mutable_eroded()->ParseFromString(bytes);
  }
  throw std::logic_error("parameters of an unknown kind");
}

}  // namespace affskel::wire
