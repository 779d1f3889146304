#pragma once

#include <gtest/gtest.h>

#include <string>

#include "derive/derive.h"
#include "sample_job.h"

namespace affskel::worker {

/// A lease of a task of this kind, on the sample job.
inline v1::Lease lease_of(v1::TaskKind kind) {
  return other_lease("t", kind);
}

/// What a task made, as its message.
template <typename Message>
Message parsed(const Derived& derived) {
  Message message;
  EXPECT_TRUE(message.ParseFromString(derived.data));
  return message;
}

/// The parts of a finished job, by its curve.
inline v1::SolidParts parts_of(const PreparedJob& prepared, const std::string& field, double threshold = 0,
                               unsigned threads = 1) {
  v1::Lease lease = lease_of(v1::TASK_KIND_PARTS);
  lease.mutable_skeleton()->set_operator_(v1::OPERATOR_CURVE);
  lease.mutable_skeleton()->set_threshold(threshold);
  return parsed<v1::SolidParts>(derive(lease, prepared, field, nullptr, threads));
}

}  // namespace affskel::worker
