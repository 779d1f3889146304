#include "reference.h"

#include <filesystem>
#include <stdexcept>

#include "ledger.h"
#include "stage.h"
#include "tools/files.h"

namespace affskel::chaos {
namespace {

std::string fetch(const Api& api, const std::string& id, v1::ArtifactKind kind) {
  std::string bytes;
  // Also of a healthy server: it closes connections that were idle while the reference was computed.
  const grpc::Status status =
      until_answered("the reference", [&] { return api.fetch(artefact(id, kind), bytes, kPatience); });
  if (!status.ok()) throw std::runtime_error("no reference: " + status.error_message());
  return bytes;
}

void must_equal_computed(const Stage& stage, const std::string& id, const std::string& computed) {
  const std::string file = stage.path(id + ".csv");
  const Command fetch_text{
      {stage.programs().client, "--server", stage.address(), "fetch", id, "field", "-o", file}, "", "", {}};
  if (run(fetch_text, kPatience) != 0) throw std::runtime_error("the reference cannot be fetched as text");
  const auto where = difference(tests::read_file(file), computed);
  if (where) throw std::runtime_error("the service's field is not that of compute: " + *where);
}

}  // namespace

void make_references(const Programs& programs, const std::string& dir, Catalogue& catalogue) {
  std::filesystem::create_directories(dir);
  Stage stage(programs, dir, dir + "/data");
  stage.start_server();
  stage.start_workers();
  stage.wait_for_server();
  for (std::size_t recipe = 0; recipe < recipes().size(); ++recipe) {
    v1::SubmitJobResponse answer;
    const Submission submission = catalogue.next(recipe, std::string("reference-") + recipes()[recipe].name);
    const grpc::Status status =
        until_answered("the reference", [&] { return stage.api().submit(submission, answer, kPatience); });
    if (!status.ok()) throw std::runtime_error("no reference: " + status.error_message());
    const std::string id = answer.job().id();
    const v1::Job job = stage.api().follow(id, [](const v1::Job&) { return false; });
    if (job.state() != v1::JOB_STATE_DONE) throw std::runtime_error("no reference: " + job.error().message());
    catalogue.set_reference(recipe, {fetch(stage.api(), id, recipes()[recipe].field_kind()),
                                     fetch(stage.api(), id, v1::ARTIFACT_KIND_SKELETON)});
    must_equal_computed(stage, id, catalogue.computed_text(programs, recipe));
  }
}

}  // namespace affskel::chaos
