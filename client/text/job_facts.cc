#include "client/text/job_facts.h"

#include "base/number_text.h"
#include "client/text/words.h"

namespace affskel::client {
namespace {

core::FileFact number_fact(const std::string& key, double number) {
  return {key, base::to_text(number), number};
}

}  // namespace

core::FileFacts job_facts(const v1::Job& job, const std::string& what) {
  const v1::PreparedSummary& prepared = job.prepared();
  const std::string& asked = job.params().directions();
  return {{"content", what + " of " + job.name()},
          {"job", job.id()},
          {"mesh_sha256", job.mesh_sha256()},
          number_fact("v0", prepared.volume()),
          number_fact("spacing", prepared.spacing()),
          {"sample_points", std::to_string(prepared.points()), static_cast<double>(prepared.points())},
          {"directions",
           (asked.empty() ? "triangles" : asked) + " (" + std::to_string(prepared.directions()) + ")"},
          {"minimum",
           job.params().minimum() == v1::MINIMUM_INFIMUM ? "over all directions" : "over these directions"},
          {"frame", frame_word(job.params().frame())},
          {"core_version", job.core_version()},
          {"units", core::kFileUnits}};
}

std::vector<std::string> comment_lines(const core::FileFacts& facts) {
  std::vector<std::string> lines;
  for (const core::FileFact& fact : facts) lines.push_back(fact.key + " " + fact.text);
  return lines;
}

}  // namespace affskel::client
