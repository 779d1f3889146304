#include "wire/artifact_kinds.h"

#include <google/protobuf/descriptor.h>
#include <gtest/gtest.h>

#include <set>
#include <string>

#include "wire/params.h"
#include "wire/words.h"

namespace affskel::wire {
namespace {

TEST(ArtifactKinds, EveryKindOfTheProtocolHasOneRow) {
  const auto* type = v1::ArtifactKind_descriptor();
  for (int i = 0; i < type->value_count(); ++i) {
    const auto kind = static_cast<v1::ArtifactKind>(type->value(i)->number());
    EXPECT_EQ(find_artifact_kind(kind) != nullptr, kind != v1::ARTIFACT_KIND_UNSPECIFIED)
        << type->value(i)->name();
  }
  EXPECT_EQ(find_artifact_kind(static_cast<v1::ArtifactKind>(1000)), nullptr);
}

TEST(ArtifactKinds, EveryTaskThatDerivesMakesOneKindOfItsName) {
  const auto* type = v1::TaskKind_descriptor();
  std::set<v1::ArtifactKind> made;
  for (int i = 0; i < type->value_count(); ++i) {
    const auto task = static_cast<v1::TaskKind>(type->value(i)->number());
    const ArtifactKindInfo* row = find_derived_kind(task);
    const bool derives =
        task > v1::TASK_KIND_ERODE && task != v1::TASK_KIND_VERIFY && task != v1::TASK_KIND_REFINE;
    ASSERT_EQ(row != nullptr, derives) << type->value(i)->name();
    if (row == nullptr) continue;
    EXPECT_EQ(row->name(), word(task)) << "the database has one name for both";
    EXPECT_TRUE(made.insert(row->kind).second);
  }
}

TEST(ArtifactKinds, MessagesAreThoseOfTheProtocol) {
  const auto* pool = google::protobuf::DescriptorPool::generated_pool();
  for (const ArtifactKindInfo& row : artifact_kinds()) {
    if (row.message.empty()) continue;
    EXPECT_NE(pool->FindMessageTypeByName(std::string(row.message)), nullptr) << row.message;
  }
}

TEST(ArtifactKinds, ParametersOfAnotherKindAreRefused) {
  const auto refused = [](const v1::FetchArtifactRequest& request) -> std::string {
    try {
      check_request(request);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  for (const ArtifactKindInfo& row : artifact_kinds()) {
    v1::FetchArtifactRequest request;
    request.set_kind(row.kind);
    EXPECT_EQ(refused(request), "");
    request.mutable_skeleton();
    const bool skeleton = row.params == ArtifactParams::kSkeleton ||
                          row.params == ArtifactParams::kOperator || row.params == ArtifactParams::kCurve;
    EXPECT_EQ(refused(request).empty(), skeleton) << row.name();
    request.clear_skeleton();
    request.mutable_surface();
    EXPECT_EQ(refused(request).empty(), row.params == ArtifactParams::kSurface) << row.name();
    request.clear_surface();
    request.mutable_eroded();
    EXPECT_EQ(refused(request).empty(), row.params == ArtifactParams::kEroded) << row.name();
  }
  v1::FetchArtifactRequest request;
  EXPECT_EQ(refused(request), "unknown kind of artefact: 0");
  request.set_kind(v1::ARTIFACT_KIND_SURFACE);
  request.mutable_skeleton();
  EXPECT_EQ(
      refused(request),
      "the parameters 'skeleton' are for SKELETON, DIVERGENCE and PARTS (SURFACE has surface.skeleton), not for"
      " ARTIFACT_KIND_SURFACE");
}

// Of the job's own skeleton they are no function.
TEST(ArtifactKinds, PartsAreThoseOfTheCurve) {
  v1::SkeletonParams own;
  own.set_operator_(v1::OPERATOR_FLUX);
  own.set_threshold(0.5);
  const ArtifactKindInfo& parts = *find_artifact_kind(v1::ARTIFACT_KIND_PARTS);
  v1::FetchArtifactRequest request;
  request.set_kind(v1::ARTIFACT_KIND_PARTS);
  const CanonicalParams absent = artifact_params(parts, request, own);
  request.mutable_skeleton()->set_operator_(v1::OPERATOR_CURVE);
  EXPECT_EQ(artifact_params(parts, request, own).key, absent.key);
  request.mutable_skeleton()->set_threshold(3);
  EXPECT_NE(artifact_params(parts, request, own).key, absent.key);
  v1::Lease lease;
  ASSERT_TRUE(set_task_params(parts.params, artifact_params(parts, request, own).bytes, lease));
  EXPECT_EQ(lease.skeleton().operator_(), v1::OPERATOR_CURVE);
  EXPECT_EQ(lease.skeleton().threshold(), 3);
  request.mutable_skeleton()->set_operator_(v1::OPERATOR_RIDGE);
  EXPECT_THROW(artifact_params(parts, request, own), std::invalid_argument);
}

TEST(ArtifactKinds, WhatIsAbsentIsTheJobsOwn) {
  v1::SkeletonParams own;
  own.set_operator_(v1::OPERATOR_FLUX);
  own.set_threshold(0.5);
  v1::FetchArtifactRequest request;
  request.set_kind(v1::ARTIFACT_KIND_SKELETON);
  const ArtifactKindInfo& skeleton = *find_artifact_kind(v1::ARTIFACT_KIND_SKELETON);
  EXPECT_EQ(artifact_params(skeleton, request, own).key, cache_key(own));
  v1::Lease lease;
  ASSERT_TRUE(set_task_params(skeleton.params, artifact_params(skeleton, request, own).bytes, lease));
  EXPECT_EQ(lease.skeleton().operator_(), v1::OPERATOR_FLUX);
  const ArtifactKindInfo& surface = *find_artifact_kind(v1::ARTIFACT_KIND_SURFACE);
  ASSERT_TRUE(set_task_params(surface.params, artifact_params(surface, request, own).bytes, lease));
  EXPECT_EQ(lease.surface().skeleton().threshold(), 0.5);
  request.mutable_skeleton()->set_threshold(3);
  EXPECT_NE(artifact_params(skeleton, request, own).key, cache_key(own));
  EXPECT_FALSE(set_task_params(skeleton.params, "\xFF", lease));
}

}  // namespace
}  // namespace affskel::wire
