#include "client/operations/artifact_calls.h"

#include <algorithm>
#include <condition_variable>
#include <thread>

#include "base/mutex.h"
#include "client/artifacts/solid_parts.h"
#include "client/files/read/input_file.h"

namespace affskel::client {
namespace {

constexpr std::chrono::seconds kWaitBeforeNote{2};

// Says that a computation is being waited for, unless it is over soon.
class WaitingNote {
 public:
  WaitingNote(const Session& session, const std::string& what)
      : thread_([this, &session, what] {
          base::MutexLock lock(mutex_);
          if (!over_.wait_for(lock, kWaitBeforeNote, [this] {
                mutex_.assert_held();
                return done_;
              })) {
            session.notify(note("WAITING", "waiting for a worker to compute the " + what));
          }
        }) {}
  ~WaitingNote() {
    {
      const base::MutexLock lock(mutex_);
      done_ = true;
    }
    over_.notify_all();
    thread_.join();
  }
  WaitingNote(const WaitingNote&) = delete;
  WaitingNote& operator=(const WaitingNote&) = delete;

 private:
  base::Mutex mutex_;
  std::condition_variable_any over_;
  bool done_ ABSL_GUARDED_BY(mutex_) = false;
  std::thread thread_;
};

bool in_range(const google::protobuf::RepeatedField<std::uint32_t>& indices, int vertices) {
  return std::all_of(indices.begin(), indices.end(),
                     [&](std::uint32_t v) { return v < static_cast<std::uint32_t>(vertices); });
}

// With E at every vertex.
bool is_surface(const v1::TriangleMesh& mesh) {
  const int vertices = mesh.xyz_size() / 3;
  return mesh.xyz_size() == 3 * vertices && mesh.erosion_size() == vertices && mesh.corners_size() % 3 == 0 &&
         in_range(mesh.corners(), vertices);
}

bool is_sheet(const v1::TriangleMesh& mesh) {
  const int vertices = mesh.xyz_size() / 3;
  return is_surface(mesh) && mesh.strength_size() == vertices && mesh.segments_size() % 2 == 0 &&
         in_range(mesh.segments(), vertices);
}

}  // namespace

v1::FetchArtifactRequest request_for(const std::string& job, v1::ArtifactKind kind) {
  v1::FetchArtifactRequest request;
  request.set_job(job);
  request.set_kind(kind);
  return request;
}

FieldSource field_source(Session& session, const v1::Job& job) {
  if (job.params().minimum() == v1::MINIMUM_INFIMUM) return {v1::ARTIFACT_KIND_REFINED, std::nullopt};
  return {v1::ARTIFACT_KIND_FIELD,
          fetch_message<v1::Directions>(session, job.id(), v1::ARTIFACT_KIND_DIRECTIONS, "direction set")};
}

std::string fetch_patiently(Session& session, const v1::FetchArtifactRequest& request,
                            v1::ArtifactHeader& header, const std::string& what) {
  const WaitingNote waiting(session, what);
  return session.fetch_bytes(request, &header);
}

v1::ArtifactHeader fetch_patiently(Session& session, const v1::FetchArtifactRequest& request,
                                   const std::function<std::unique_ptr<ArtifactSink>()>& make_sink,
                                   const std::string& what) {
  const WaitingNote waiting(session, what);
  return session.fetch(request, make_sink);
}

v1::TriangleMesh fetch_sheet(Session& session, const std::string& job, const v1::SkeletonParams& params) {
  v1::FetchArtifactRequest request = request_for(job, v1::ARTIFACT_KIND_SURFACE);
  *request.mutable_surface()->mutable_skeleton() = params;
  v1::ArtifactHeader header;
  v1::TriangleMesh sheet;
  if (!sheet.ParseFromString(fetch_patiently(session, request, header, "sheet")) || !is_sheet(sheet)) {
    throw ClientError(ExitCode::kInternal, "the server sent a damaged sheet");
  }
  return sheet;
}

v1::SolidParts fetch_solid_parts(Session& session, const std::string& job, double threshold,
                                 v1::ArtifactHeader& header) {
  v1::FetchArtifactRequest request = request_for(job, v1::ARTIFACT_KIND_PARTS);
  request.mutable_skeleton()->set_operator_(v1::OPERATOR_CURVE);
  request.mutable_skeleton()->set_threshold(threshold);
  return parse_solid_parts(fetch_patiently(session, request, header, "parts of the solid"));
}

v1::TriangleMesh fetch_eroded_surface(Session& session, const std::string& job, double level) {
  v1::FetchArtifactRequest request = request_for(job, v1::ARTIFACT_KIND_ERODED_SURFACE);
  request.mutable_eroded()->set_fraction(level);
  v1::ArtifactHeader header;
  v1::TriangleMesh surface;
  if (!surface.ParseFromString(fetch_patiently(session, request, header, "eroded solid")) ||
      !is_surface(surface) || surface.area_size() != surface.erosion_size()) {
    throw ClientError(ExitCode::kInternal, "the server sent a damaged eroded solid");
  }
  return surface;
}

core::Mesh fetch_mesh(Session& session, const std::string& job) {
  return parse_mesh(session.fetch_bytes(request_for(job, v1::ARTIFACT_KIND_MESH)), "mesh of job " + job).mesh;
}

}  // namespace affskel::client
