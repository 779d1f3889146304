#include "client/commands/transfer.h"

#include <condition_variable>
#include <mutex>
#include <nlohmann/json.hpp>
#include <thread>

#include "client/exporters/atomic_file.h"
#include "client/exporters/field_writer.h"
#include "client/exporters/mesh_writer.h"
#include "client/exporters/numbers.h"
#include "client/exporters/skeleton_writer.h"

namespace affskel::client {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::seconds kWaitBeforeNote{2};

// Says that a computation is being waited for, unless it is over soon.
class WaitingNote {
 public:
  WaitingNote(Console& console, const std::string& what)
      : thread_([this, &console, what] {
          std::unique_lock lock(mutex_);
          if (!over_.wait_for(lock, kWaitBeforeNote, [this] { return done_; })) {
            console.note("waiting for a worker to compute the " + what);
          }
        }) {}
  ~WaitingNote() {
    {
      const std::lock_guard lock(mutex_);
      done_ = true;
    }
    over_.notify_all();
    thread_.join();
  }
  WaitingNote(const WaitingNote&) = delete;
  WaitingNote& operator=(const WaitingNote&) = delete;

 private:
  std::mutex mutex_;
  std::condition_variable over_;
  bool done_ = false;  // guarded by mutex_
  std::thread thread_;
};

v1::FetchArtifactRequest request_for(const std::string& job, v1::ArtifactKind kind) {
  v1::FetchArtifactRequest request;
  request.set_job(job);
  request.set_kind(kind);
  return request;
}

template <typename Message>
Message fetch_message(Context& context, const std::string& job, v1::ArtifactKind kind, const char* what) {
  Message message;
  if (!message.ParseFromString(context.session().fetch_bytes(request_for(job, kind)))) {
    throw ClientError(ExitCode::kInternal, std::string("the server sent a damaged ") + what);
  }
  return message;
}

// A field on its way into a file; a transfer that breaks off leaves nothing behind.
class FieldSink : public ArtifactSink {
 public:
  FieldSink(FileFormat format, const fs::path& file, const LatticePoints& points,
            const v1::Directions& directions)
      : file_(file),
        writer_(make_field_writer(format, file_, points)),
        decoder_(points, directions, *writer_) {}
  void begin(const v1::ArtifactHeader&) override {}
  void data(std::string_view bytes) override { decoder_.data(bytes); }
  void end() override {
    decoder_.finish();
    file_.commit();
  }

 private:
  AtomicFile file_;
  std::unique_ptr<FieldWriter> writer_;
  FieldDecoder decoder_;
};

class RawSink : public ArtifactSink {
 public:
  explicit RawSink(const fs::path& file) : file_(file) {}
  void begin(const v1::ArtifactHeader&) override {}
  void data(std::string_view bytes) override { file_.write(bytes); }
  void end() override { file_.commit(); }

 private:
  AtomicFile file_;
};

std::string operator_text(const v1::SkeletonParams& params) {
  return "operator zucker-hummel, threshold " +
         (params.threshold() > 0 ? shortest(params.threshold()) : std::string("default"));
}

// What a file should say about where it comes from.
std::vector<std::string> comments_for(const v1::Job& job, const v1::SkeletonParams& skeleton) {
  return {"affine skeleton of " + job.name(),
          "job " + job.id(),
          "mesh sha256 " + job.mesh_sha256(),
          "spacing " + shortest(job.prepared().spacing()) + ", " + std::to_string(job.prepared().points()) +
              " sample points, v0 " + shortest(job.prepared().volume()),
          "directions " + (job.params().directions().empty() ? "triangles" : job.params().directions()) +
              " (" + std::to_string(job.prepared().directions()) + ")",
          operator_text(skeleton)};
}

}  // namespace

std::string fetch_patiently(Context& context, const v1::FetchArtifactRequest& request,
                            v1::ArtifactHeader& header, const std::string& what) {
  context.session();  // an embedded server is announced before anything is waited for
  const WaitingNote note(context.console(), what);
  return context.session().fetch_bytes(request, &header);
}

Written transfer_field(Context& context, const std::string& job, const fs::path& file) {
  const FileFormat format = choose_format(file, field_formats(), "field");
  const v1::Job now = context.session().get_job(job);
  // The finished field first: its absence is the error to report.
  if (now.state() != v1::JOB_STATE_DONE &&
      now.directions_done() < std::max<std::uint64_t>(1, now.directions_total())) {
    throw ClientError(ExitCode::kNotFound,
                      "job " + now.id() +
                          " has no finished field yet: " + std::to_string(now.directions_done()) + " of " +
                          std::to_string(now.directions_total()) + " directions are done");
  }
  const LatticePoints points(
      fetch_message<v1::Lattice>(context, now.id(), v1::ARTIFACT_KIND_LATTICE, "lattice"));
  const auto directions =
      fetch_message<v1::Directions>(context, now.id(), v1::ARTIFACT_KIND_DIRECTIONS, "direction set");
  const v1::ArtifactHeader header = context.session().fetch(
      request_for(now.id(), v1::ARTIFACT_KIND_FIELD), [&]() -> std::unique_ptr<ArtifactSink> {
        return std::make_unique<FieldSink>(format, file, points, directions);
      });
  return {file, "field", points.count(), header.job()};
}

Written transfer_skeleton(Context& context, const std::string& job, const v1::SkeletonParams* skeleton,
                          const fs::path& file) {
  const FileFormat format = choose_format(file, skeleton_formats(), "skeleton");
  v1::FetchArtifactRequest request = request_for(job, v1::ARTIFACT_KIND_SKELETON);
  if (skeleton != nullptr) *request.mutable_skeleton() = *skeleton;
  v1::ArtifactHeader header;
  const v1::SkeletonPoints points = parse_skeleton(fetch_patiently(context, request, header, "skeleton"));
  AtomicFile out(file);
  write_skeleton(format, points, comments_for(header.job(), skeleton ? *skeleton : header.job().skeleton()),
                 out);
  out.commit();
  return {file, "skeleton", static_cast<std::uint64_t>(points.point_size()), header.job()};
}

Written transfer_surface(Context& context, const std::string& job, const v1::SurfaceParams* surface,
                         const fs::path& file) {
  const FileFormat format = choose_format(file, surface_formats(), "surface");
  v1::FetchArtifactRequest request = request_for(job, v1::ARTIFACT_KIND_SURFACE);
  if (surface != nullptr) *request.mutable_surface() = *surface;
  v1::ArtifactHeader header;
  const core::Mesh mesh = parse_surface(fetch_patiently(context, request, header, "surface"));
  const bool own = surface == nullptr || !surface->has_skeleton();
  AtomicFile out(file);
  write_mesh(format, mesh, comments_for(header.job(), own ? header.job().skeleton() : surface->skeleton()),
             [&](std::string_view bytes) { out.write(bytes); });
  out.commit();
  return {file, "surface", mesh.triangles.size(), header.job()};
}

Written transfer_mesh(Context& context, const std::string& job, const fs::path& file) {
  const v1::ArtifactHeader header = context.session().fetch(
      request_for(job, v1::ARTIFACT_KIND_MESH),
      [&]() -> std::unique_ptr<ArtifactSink> { return std::make_unique<RawSink>(file); });
  return {file, "mesh", header.bytes(), header.job()};
}

nlohmann::ordered_json written_json(const Written& written) {
  const char* unit = written.kind == "surface" ? "triangles" : written.kind == "mesh" ? "bytes" : "points";
  return {{"job", written.job.id()},
          {"artefact", written.kind},
          {"file", written.file.string()},
          {unit, written.items}};
}

void tell_written(Console& console, const Written& written) {
  const char* unit = written.kind == "surface" ? "triangles" : written.kind == "mesh" ? "bytes" : "points";
  console.note("wrote " + written.file.string() + " (" + written.kind + ", " + std::to_string(written.items) +
               " " + unit + ")");
}

}  // namespace affskel::client
