#include <algorithm>
#include <array>

#include "base/atomic_file.h"
#include "client/base/stance.h"
#include "client/operations/archive.h"
#include "client/operations/fetch.h"
#include "client/operations/job_notices.h"
#include "client/operations/page.h"
#include "client/operations/picture.h"
#include "client/render/scene.h"
#include "client/text/portable_name.h"
#include "client/view/page.h"
#include "client/web/api_answers.h"
#include "client/web/handlers.h"
#include "wire/params.h"

namespace affskel::client {
namespace {

constexpr int kPictureWidth = 1600, kThumbnailWidth = 200;

// As browsers name them; what has none is bytes.
std::string type_of(const std::string& extension) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 8> kTypes = {{
      {".csv", "text/csv; charset=utf-8"},
      {".dat", "text/plain; charset=utf-8"},
      {".xyz", "text/plain; charset=utf-8"},
      {".off", "model/vnd.geomview.off"},
      {".obj", "model/obj"},
      {".stl", "model/stl"},
      {".png", "image/png"},
      {".html", "text/html; charset=utf-8"},
  }};
  for (const auto& [known, type] : kTypes) {
    if (extension == known) return std::string(type);
  }
  return "application/octet-stream";
}

std::string file_name(const std::string& job, const std::string& what, const std::string& extension) {
  return portable_name(job) + "." + what + extension;
}

// RFC 6266: for old programs without what is not ASCII.
std::string disposition(const ResultFile& result) {
  std::string plain, encoded;
  constexpr std::string_view kDigits = "0123456789ABCDEF";
  for (const char c : result.name) {
    const auto byte = static_cast<unsigned char>(c);
    plain += byte < 0x80 && c != '"' && c != '\\' ? c : '_';
    if (std::isalnum(byte) != 0 || c == '.' || c == '-' || c == '_') {
      encoded += c;
    } else {
      encoded += {'%', kDigits[byte >> 4], kDigits[byte & 15]};
    }
  }
  return std::string(result.shown ? "inline" : "attachment") + "; filename=\"" + plain +
         "\"; filename*=UTF-8''" + encoded;
}

v1::ErodedParams eroded_of(const nlohmann::json& body) {
  v1::ErodedParams eroded;
  const double fraction = number_member(body, "fraction");
  if (fraction != 0) eroded.set_fraction(fraction);
  return eroded;
}

void write_whole(const std::filesystem::path& path, const std::string& bytes) {
  base::AtomicFile file(path);
  file.write(bytes);
  file.commit();
}

// What was made, and how its file is named.
struct Made {
  v1::Job job;
  Notices notices;
  nlohmann::ordered_json facts = nlohmann::ordered_json::object();
};

// Of v0, of the eroded solid that is drawn, too; 0: none.
double level_member(const nlohmann::json& body) {
  const double level = number_member(body, "fraction");
  if (level < 0) throw ClientError(ExitCode::kUsage, "the level must be a share of v0 above 0 and below 1");
  return level;
}

// @param look of the picture: what options say beside the skeleton.
std::shared_ptr<const Picture> drawn(WebState& web, Session& server, const v1::Job& job,
                                     const PictureOptions& options, const std::string& look) {
  const auto kept_so = kept_stance(job);
  const std::string stands = kept_so ? stance_text(*kept_so) : "";
  const std::string key = job.id() + " " + std::to_string(job.finished_ms()) + " " +
                          wire::cache_key(skeleton_params(options.skeleton, job)) + " " + stands + " " + look;
  if (auto kept = web.pictures.find(key)) return kept;
  auto picture = std::make_shared<const Picture>(make_picture(server, job, options));
  web.pictures.put(key, picture);
  return picture;
}

Made make_picture(WebState& web, Session& server, const nlohmann::json& body, const std::string& job,
                  const std::filesystem::path& path) {
  const std::string background = text_member(body, "background", "white");
  PictureOptions options;
  options.skeleton = skeleton_member(body);
  options.render.width = kPictureWidth;
  options.render.background = parse_background(background);
  options.level = level_member(body);
  Made made{finished_job(server, job), {}};
  const auto picture =
      drawn(web, server, made.job, options, background + " " + std::to_string(options.level));
  write_whole(path, picture->png);
  made.notices = picture->notices;
  made.facts["shown"] = picture->shown;
  return made;
}

Made make_view(Session& server, const nlohmann::json& body, const std::string& job,
               const std::filesystem::path& path) {
  const SkeletonChoice skeleton = skeleton_member(body);
  Made made{finished_job(server, job), {}};
  std::vector<ViewSubject> subjects = {{made.job, skeleton_params(skeleton, made.job)}};
  if (const std::string beside = text_member(body, "beside"); !beside.empty()) {
    const v1::Job other = finished_job(server, beside);
    subjects.push_back({other, skeleton_params(skeleton, other)});
  }
  Page page = make_page(server, subjects, {{}, level_member(body)});
  write_whole(path, page.html);
  made.notices = std::move(page.notices);
  return made;
}

Made make_artifact(Session& server, const nlohmann::json& body, const std::string& job,
                   const std::string& name, const std::filesystem::path& path) {
  FetchRequest request{job, name, {path}, skeleton_member(body)};
  request.eroded = eroded_of(body);
  Fetched fetched = fetch(server, request);
  Made made{std::move(fetched.job), std::move(fetched.notices)};
  made.facts[fetched.unit + "s"] = fetched.items;
  if (fetched.volume) made.facts["volume"] = *fetched.volume;
  return made;
}

// The extension of what is asked for.
// @throws ClientError kUsage when there is no such artefact or format.
std::string extension_for(const std::string& artifact, const std::string& format) {
  if (artifact == "picture") return ".png";
  if (artifact == "view") return ".html";
  const std::vector<std::string> possible = artifact_extensions(artifact);
  if (format.empty()) return possible.front();
  if (std::find(possible.begin(), possible.end(), format) == possible.end())
    throw ClientError(ExitCode::kUsage, "'" + artifact + "' is not written as '" + format + "'");
  return format;
}

}  // namespace

std::string WebCall::keep(ResultFile result) const {
  const std::uint64_t bytes = result.file->bytes();
  return "/results/" + web.results.put(session.id, std::make_shared<ResultFile>(std::move(result)), bytes);
}

http::Response make_result(WebCall& call) {
  const nlohmann::json body = json_body(call.request);
  const std::string artifact = text_member(body, "artefact");
  const std::string extension = extension_for(artifact, text_member(body, "format"));
  auto file = std::make_unique<OwnedFile>(call.web.folder.new_path(extension));
  Session server = call.server();
  Made made = artifact == "picture" ? make_picture(call.web, server, body, call.argument, file->path())
              : artifact == "view"  ? make_view(server, body, call.argument, file->path())
                                    : make_artifact(server, body, call.argument, artifact, file->path());
  nlohmann::ordered_json answer = std::move(made.facts);
  const bool shown = artifact == "picture" || artifact == "view";
  answer["name"] = file_name(made.job.name(), artifact, extension);
  answer["size"] = file->bytes();
  answer["warnings"] = warnings_json(made.notices);
  answer["href"] = call.keep({std::move(file), answer["name"].get<std::string>(), type_of(extension), shown,
                              artifact == "view" ? view_page_policy() : std::string()});
  return api_answer(answer, 201);
}

http::Response make_archive(WebCall& call) {
  const nlohmann::json body = json_body(call.request);
  const auto ids = body.find("jobs");
  if (ids == body.end() || !ids->is_array() || ids->empty() ||
      !std::all_of(ids->begin(), ids->end(), [](const nlohmann::json& id) { return id.is_string(); }))
    throw ClientError(ExitCode::kUsage, "'jobs' must be ids of jobs");
  if (ids->size() > kMaxArchived)
    throw ClientError(ExitCode::kLimit, "an archive holds " + std::to_string(kMaxArchived) + " jobs at most");
  Session server = call.server();
  std::vector<v1::Job> jobs;
  for (const nlohmann::json& id : *ids) jobs.push_back(finished_job(server, id.get<std::string>()));
  auto file = std::make_unique<OwnedFile>(call.web.folder.new_path(".zip"));
  write_archive(server, jobs, file->path());
  const std::string name = jobs.size() == 1 ? portable_name(jobs.front().name()) + ".zip" : "affskel.zip";
  nlohmann::ordered_json answer = {{"name", name}, {"size", file->bytes()}};
  answer["href"] = call.keep({std::move(file), name, "application/zip", false, {}});
  return api_answer(answer, 201);
}

http::Response send_result(WebCall& call) {
  const auto result = call.web.results.find(call.session.id, call.argument);
  if (!result) throw ClientError(ExitCode::kNotFound, "the file is not kept here any more; make it again");
  http::Response response;
  response.headers = {{"Content-Type", result->type}, {"Content-Disposition", disposition(*result)}};
  if (!result->policy.empty()) response.headers.emplace_back("Content-Security-Policy", result->policy);
  response.file = result->file->path();
  response.held = result;
  return response;
}

http::Response send_thumbnail(WebCall& call) {
  Session server = call.server();
  const v1::Job job = finished_job(server, call.argument);
  const std::string background = call.request.parameter("background");
  PictureOptions options;
  options.render.width = kThumbnailWidth;
  options.render.bare = true;
  options.render.background = parse_background(background.empty() ? "white" : background);
  http::Response response;
  response.headers = {{"Content-Type", "image/png"}};
  response.body = drawn(call.web, server, job, options, "thumbnail " + background)->png;
  return response;
}

}  // namespace affskel::client
