// Files of values at the sample points of a job.

#include <algorithm>

#include "base/atomic_file.h"
#include "client/artifacts/divergence_writer.h"
#include "client/artifacts/field_writer.h"
#include "client/operations/artifact_calls.h"
#include "client/operations/artifact_files.h"
#include "client/operations/job_notices.h"
#include "client/text/job_facts.h"
#include "client/text/words.h"
#include "core/lattice/lattice_coordinates.h"
#include "wire/params.h"

namespace affskel::client {
namespace {

namespace fs = std::filesystem;

// A field on its way into a file; a transfer that breaks off leaves nothing behind.
class FieldSink : public ArtifactSink {
 public:
  FieldSink(FileFormat format, const fs::path& file, const LatticePoints& points, const FieldSource& source,
            const v1::Job& job, std::vector<std::uint32_t> parts)
      : file_(file),
        writer_(format, file_, points, job.prepared().volume(), job_facts(job, "erosion field"),
                std::move(parts), source.set() == nullptr),
        decoder_(points, source.set(), writer_) {}
  void begin(const v1::ArtifactHeader&) override {}
  void data(std::string_view bytes) override { decoder_.data(bytes); }
  void end() override {
    decoder_.finish();
    file_.commit();
  }

 private:
  base::AtomicFile file_;
  FieldWriter writer_;
  FieldDecoder decoder_;
};

class DivergenceSink : public ArtifactSink {
 public:
  DivergenceSink(FileFormat format, const fs::path& file, const LatticePoints& points,
                 const core::FileFacts& facts)
      : file_(file), writer_(format, file_, points, facts) {}
  void begin(const v1::ArtifactHeader&) override {}
  void data(std::string_view bytes) override { writer_.data(bytes); }
  void end() override {
    writer_.finish();
    file_.commit();
  }

 private:
  base::AtomicFile file_;
  DivergenceWriter writer_;
};

LatticePoints lattice_of(Session& session, const std::string& job) {
  return LatticePoints(fetch_message<v1::Lattice>(session, job, v1::ARTIFACT_KIND_LATTICE, "lattice"));
}

std::vector<std::uint32_t> parts_of_points(Session& session, const std::string& job, std::uint64_t points) {
  v1::ArtifactHeader header;
  const v1::SolidParts parts = fetch_solid_parts(session, job, 0, header);
  if (static_cast<std::uint64_t>(parts.point_part_size()) != points)
    throw ClientError(ExitCode::kInternal, "the server sent parts of another number of sample points");
  return {parts.point_part().begin(), parts.point_part().end()};
}

// Refuses what cannot place a turned lattice, and says what most programs make of the others.
Notices grid_notices(FileFormat format, const LatticePoints& points, const Destination& destination) {
  try {
    core::check_places(format, points.grid());
  } catch (const core::CoreError& error) {
    throw ClientError(ExitCode::kUsage, error.what(), destination.name());
  }
  const bool by_matrix = format == FileFormat::kVtkHdf || format == FileFormat::kHdf;
  if (!by_matrix || core::is_upright(points.grid())) return {};
  return {warning("TURNED_LATTICE",
                  "the lattice is turned or sheared, and this format says so by the matrix Direction, which "
                  "ParaView 5.11 and VTK 9.1 pass over; .vts holds the points themselves",
                  destination.name())};
}

}  // namespace

Fetched fetch_field(Session& session, const FetchRequest& request) {
  const FileFormat format =
      request.parts ? choose_format(request.destination, parted_field_formats(), "field with parts")
                    : choose_format(request.destination, field_formats(), "field");
  const v1::Job now = session.get_job(request.job);
  // The finished field first: its absence is the error to report.
  const bool on_the_way = now.stage() == v1::JOB_STAGE_REFINE ||
                          now.directions_done() < std::max<std::uint64_t>(1, now.directions_total());
  if (now.state() != v1::JOB_STATE_DONE && on_the_way) {
    throw ClientError(ExitCode::kNotFound,
                      "there is no finished field: job " + now.id() + " " + unfinished_text(now));
  }
  const LatticePoints points = lattice_of(session, now.id());
  Notices notices = grid_notices(format, points, request.destination);
  const FieldSource source = field_source(session, now);
  const std::vector<std::uint32_t> parts =
      request.parts ? parts_of_points(session, now.id(), points.count()) : std::vector<std::uint32_t>();
  const v1::ArtifactHeader header =
      session.fetch(request_for(now.id(), source.kind), [&]() -> std::unique_ptr<ArtifactSink> {
        return std::make_unique<FieldSink>(format, request.destination.file, points, source, now, parts);
      });
  Fetched fetched{request.destination, "field", "point", points.count(), header.job()};
  fetched.notices = std::move(notices);
  return fetched;
}

Fetched fetch_divergence(Session& session, const FetchRequest& request) {
  const FileFormat format = choose_format(request.destination, divergence_formats(), "divergence");
  const v1::Job now = session.get_job(request.job);
  v1::FetchArtifactRequest asked = request_for(now.id(), v1::ARTIFACT_KIND_DIVERGENCE);
  v1::Operator which = wire::usual_divergence(now.skeleton().operator_());
  if (!request.skeleton.operator_name.empty()) which = operator_named(request.skeleton.operator_name);
  asked.mutable_skeleton()->set_operator_(which);
  const LatticePoints points = lattice_of(session, now.id());
  Notices notices = grid_notices(format, points, request.destination);
  core::FileFacts facts = job_facts(now, "divergence of the optimal normals");
  facts.push_back({"operator", operator_word(which)});
  const v1::ArtifactHeader header = fetch_patiently(
      session, asked,
      [&]() -> std::unique_ptr<ArtifactSink> {
        return std::make_unique<DivergenceSink>(format, request.destination.file, points, facts);
      },
      "divergence");
  Fetched fetched{request.destination, "divergence", "point", points.count(), header.job()};
  fetched.notices = std::move(notices);
  return fetched;
}

}  // namespace affskel::client
