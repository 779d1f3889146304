#include "client/operations/shape_output.h"

#include "client/text/job_facts.h"
#include "client/text/skeleton_text.h"

namespace affskel::client {

void ShapeOutput::write(WriteShape writer, const ShapeFile& shape, const v1::Job& job, const Told& told) {
  write_by([&](const std::vector<std::string>& comments,
               const WriteBytes& write) { writer(format_, shape, comments, write); },
           job, told);
}

void ShapeOutput::write_by(const Writer& writer, const v1::Job& job, const Told& told) {
  core::FileFacts facts = job_facts(job, told.what);
  facts.push_back({told.key, told.how});
  std::vector<std::string> comments = comment_lines(facts);
  if (told.quality != nullptr) {
    for (const auto& [name, value] : quality_lines(*told.quality))
      comments.push_back("quality " + name + ": " + value);
  }
  write_into(file_, [&](const WriteBytes& write) { writer(comments, write); });
  file_.commit();
}

}  // namespace affskel::client
