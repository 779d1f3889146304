#include <chrono>
#include <cmath>
#include <filesystem>

#include "base/atomic_file.h"
#include "base/utf8.h"
#include "client/files/read/input_file.h"
#include "client/operations/inspection.h"
#include "client/operations/mesh_picture.h"
#include "client/operations/repair.h"
#include "client/operations/submission.h"
#include "client/render/scene.h"
#include "client/text/printable.h"
#include "client/view/page.h"
#include "client/web/api_answers.h"
#include "client/web/handlers.h"
#include "client/web/until_gone.h"
#include "core/lattice/lattice.h"
#include "core/solid/solid_frame.h"
#include "core/text/off_file.h"

namespace affskel::client {
namespace {

constexpr int kMeshPictureWidth = 1200;
constexpr std::uint64_t kMaxDrawn = 4'000'000;  // triangles
constexpr std::uint64_t kMaxTurned = 500'000;   // whose page has 10 MB
// Up to so many points the lattice is laid to count them.
constexpr double kMaxCounted = 4e6;

// What was asked of the lattice.  @throws ClientError kUsage unless it is a spacing or a number of points.
void read_sampling(double spacing, double points, Submission& submission) {
  if (spacing > 0) {
    submission.spacing = spacing;
  } else if (points >= 1 && points <= double(kMaxPoints)) {
    submission.points = static_cast<std::uint64_t>(std::llround(points));
  } else {
    throw ClientError(ExitCode::kUsage, "a spacing above 0 is needed, or a number of points from 1 to 2^31");
  }
}

double number_of(const http::Request& request, const std::string& name) {
  const std::string text = request.parameter(name);
  if (text.empty()) return 0;
  try {
    std::size_t end = 0;
    const double value = std::stod(text, &end);
    if (end == text.size() && std::isfinite(value)) return value;
  } catch (const std::exception&) {  // no number, or beyond a double
  }
  throw ClientError(ExitCode::kUsage, "'" + name + "' must be a number");
}

// The mesh to turn.
std::string view_of(const WebCall& call, const InputFile& input, const std::string& name) {
  auto file = std::make_unique<OwnedFile>(call.web.folder.new_path(".html"));
  base::AtomicFile out(file->path());
  out.write(mesh_page(input, name));
  out.commit();
  return call.keep({std::move(file), "mesh.html", "text/html; charset=utf-8", true, view_page_policy()});
}

std::string picture_of(const WebCall& call, const InputFile& input, const std::string& name) {
  auto file = std::make_unique<OwnedFile>(call.web.folder.new_path(".png"));
  base::AtomicFile out(file->path());
  RenderOptions look;
  look.width = kMeshPictureWidth;
  if (const std::string background = call.request.parameter("background"); !background.empty())
    look.background = parse_background(background);
  out.write(mesh_picture(input, name, look));
  out.commit();
  return call.keep({std::move(file), "mesh.png", "image/png", true, {}});
}

std::string upload_name(const http::Request& request) {
  const std::string name = std::filesystem::path(request.parameter("name")).filename().string();
  return name.empty() ? "mesh.off" : std::string(base::truncate_utf8(one_line(name), 200));
}

std::shared_ptr<UploadedMesh> mesh_of(const WebCall& call, const std::string& key) {
  auto mesh = call.web.meshes.find(call.session.id, key);
  if (!mesh)
    throw ClientError(ExitCode::kNotFound, "the mesh is not kept here any more; choose the file again");
  return mesh;
}

Submission submission_of(const nlohmann::json& body) {
  Submission submission;
  read_sampling(number_member(body, "spacing"), number_member(body, "points"), submission);
  submission.directions = text_member(body, "directions", submission.directions);
  submission.frame = text_member(body, "frame", submission.frame);
  submission.minimum = text_member(body, "minimum", submission.minimum);
  submission.skeleton = skeleton_member(body, submission.skeleton.operator_name);
  submission.name = text_member(body, "name");
  submission.request_id = text_member(body, "request_id");
  const double priority = number_member(body, "priority", submission.priority);
  if (!(priority >= 0 && priority <= kMaxPriority) || priority != std::floor(priority))
    throw ClientError(ExitCode::kUsage, "'priority' must be 0 to " + std::to_string(kMaxPriority));
  submission.priority = static_cast<unsigned>(priority);
  return submission;
}

// The upload becomes OFF text.
void replace_upload(WebCall& call, std::string_view text) {
  auto file = std::make_unique<OwnedFile>(call.web.folder.new_path(".off"));
  base::AtomicFile out(file->path());
  out.write(text);
  out.commit();
  call.upload = std::move(file);
}

// How an upload is read.
core::MeshFileOptions reading_of(const WebCall& call, core::ExecutionContext& context) {
  core::MeshFileOptions reading;
  reading.context = &context;
  if (!call.request.parameter("isovalue").empty()) reading.isovalue = number_of(call.request, "isovalue");
  return reading;
}

struct WebSource {
  std::unique_ptr<OwnedFile> file;  // null: nothing was repaired
  std::vector<core::RepairStep> steps;
};

// The upload becomes what repair makes of it.
WebSource replace_by_repaired(WebCall& call, const std::string& name, InputFile& input,
                              core::ExecutionContext* context) {
  const std::string how = call.request.parameter("repair");
  RepairChoice choice;
  if (how == "fill") choice = {RepairChoice::Kind::kFill, HUGE_VAL};
  if (how == "wrap") choice = {RepairChoice::Kind::kWrap};
  if (how != "auto" && how != "fill" && how != "wrap")
    throw ClientError(ExitCode::kUsage, "'repair' must be auto, fill or wrap");
  Repair done = repair(input.off.mesh, name, choice, context);
  if (!done.left.empty()) throw ClientError(ExitCode::kBadInput, done.left);
  if (done.steps.empty()) return {};
  WebSource source{std::move(call.upload), std::move(done.steps)};
  replace_upload(call, core::write_off(done.mesh));
  input = read_input(call.upload->path().string());
  return source;
}

}  // namespace

// Made on request: most users look at the picture.
http::Response turn_mesh(WebCall& call) {
  const std::string name = upload_name(call.request);
  UntilGone context(call.request.gone);
  const InputFile input = read_input(call.upload->path().string(), reading_of(call, context));
  if (input.off.mesh.triangles.size() > kMaxTurned)
    throw ClientError(ExitCode::kLimit,
                      "meshes of up to " + std::to_string(kMaxTurned) + " triangles can be turned");
  return api_answer({{"href", view_of(call, input, name)}}, 201);
}

namespace {

http::Response taken_mesh(WebCall& call, UntilGone& context) {
  const std::string name = upload_name(call.request);
  InputFile input;
  WebSource source;
  nlohmann::ordered_json steps = nlohmann::ordered_json::array();
  try {
    input = read_input(call.upload->path().string(), reading_of(call, context));
    for (const Notice& told : conversion_notices(input))
      if (told.code != "CONVERTED" && told.code != "UNPACKED")
        steps.push_back({{"severity", "note"}, {"code", told.code}, {"message", told.message}});
    if (!input.told.empty()) replace_upload(call, OffText(input).view());
    if (!call.request.parameter("repair").empty()) {
      source = replace_by_repaired(call, name, input, &context);
      for (const core::RepairStep& step : source.steps)
        steps.push_back({{"severity", core::severity_word(step.severity)},
                         {"code", step.code},
                         {"message", step.message}});
    }
  } catch (const ClientError& error) {
    if (error.exit_code() != ExitCode::kBadInput) throw;
    return api_answer({{"name", name}, {"error", error.what()}, {"line", error.line()}});
  }
  Inspection inspection = inspect(input, kFewPlaces, &context);
  core::throw_if_stopped(&context);
  inspection.facts["file"] = name;
  for (auto& note : inspection.facts["notes"]) steps.push_back(std::move(note));
  inspection.facts["notes"] = std::move(steps);
  inspection.facts.erase("surfaces");  // the page shows none of them, and 250,000 are 24 MB
  nlohmann::ordered_json answer = {{"name", name}, {"facts", inspection.facts}};
  if (input.off.mesh.triangles.size() <= kMaxDrawn && !input.off.mesh.triangles.empty())
    answer["picture"] = picture_of(call, input, name);
  if (inspection.error) {
    answer["error"] = inspection.error->what();
    return api_answer(answer);
  }
  answer["advice"] = notices_json(direction_notices(*inspection.solid, Submission()));
  const std::uint64_t bytes = call.upload->bytes() + (source.file ? source.file->bytes() : 0);
  UploadedMesh mesh{std::move(call.upload), name, *std::move(inspection.solid), std::move(source.file),
                    std::move(source.steps)};
  answer["mesh"] =
      call.web.meshes.put(call.session.id, std::make_shared<UploadedMesh>(std::move(mesh)), bytes);
  return api_answer(answer);
}

}  // namespace

// That a file is no mesh is an answer, too.
http::Response take_mesh(WebCall& call) {
  const std::chrono::nanoseconds limit = call.web.options.repair_limit;
  UntilGone context(call.request.gone, limit);
  try {
    return taken_mesh(call, context);
  } catch (const std::exception&) {
    if (!context.met_limit()) throw;
    throw ClientError(ExitCode::kLimit,
                      "reading, mending and checking it takes more than " +
                          std::to_string(std::chrono::ceil<std::chrono::seconds>(limit).count()) +
                          " s of processor time (--repair-limit of affskel-client web)");
  }
}

http::Response lay_lattice(WebCall& call) {
  const auto mesh = mesh_of(call, call.argument);
  Submission asked;
  read_sampling(number_of(call.request, "spacing"), number_of(call.request, "points"), asked);
  core::LatticeOptions options;
  options.spacing = asked.spacing;
  options.target_points = asked.points;
  check_spacing(mesh->solid, asked.spacing, "");
  const double v0 = mesh->solid.volume;
  const double spacing = asked.spacing > 0 ? asked.spacing : std::cbrt(v0 / double(asked.points));
  const double points = v0 / (spacing * spacing * spacing);
  const auto uncounted = [&] {
    return api_answer({{"spacing", spacing}, {"points", std::round(points)}, {"counted", false}});
  };
  if (points > kMaxCounted) return uncounted();
  const std::string frame = call.request.parameter("frame");
  options.frame = core::solid_frame(mesh->solid, core::parse_frame(frame.empty() ? "axis" : frame));
  UntilGone context(call.request.gone);
  options.context = &context;
  // A thin solid has few points and many lines, which take the memory and the time.
  options.max_points = static_cast<std::uint64_t>(2 * kMaxCounted);
  options.max_lines = static_cast<std::uint64_t>(kMaxCounted);
  try {
    const core::Lattice lattice = core::make_lattice(mesh->solid, options);
    return api_answer({{"spacing", lattice.spacing}, {"points", lattice.points}, {"counted", true}});
  } catch (const core::CoreError& error) {
    if (error.code() != core::CoreError::Code::kLimit) throw;
    return uncounted();
  }
}

http::Response submit_mesh(WebCall& call) {
  const nlohmann::json body = json_body(call.request);
  const auto mesh = mesh_of(call, text_member(body, "mesh"));
  Submission submission = submission_of(body);
  if (submission.name.empty()) submission.name = job_name(mesh->name);
  const InputFile input = read_input(mesh->file->path().string());
  check_submission(mesh->solid, input, submission);
  std::optional<MeshSource> source;
  if (mesh->source) {
    const InputFile came = read_input(mesh->source->path().string());
    source = {std::string(OffText(came).view()), mesh->steps};
  }
  Session server = call.server();
  const auto [job, existed] =
      submit(server, call.web.backend.environment(), input, source ? &*source : nullptr, submission);
  return api_answer({{"id", job.id()}, {"name", job.name()}, {"existed", existed}}, existed ? 200 : 201);
}

}  // namespace affskel::client
