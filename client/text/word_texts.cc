#include "client/text/word_texts.h"

#include <map>

#include "affskel/v1/types.pb.h"
#include "wire/words.h"

namespace affskel::client {
namespace {

using nlohmann::ordered_json;

template <typename Enum>
using Texts = std::map<Enum, const char*>;

template <typename Enum>
ordered_json by_word(const Texts<Enum>& texts) {
  ordered_json all = ordered_json::object();
  for (const std::string& word : wire::words(*google::protobuf::GetEnumDescriptor<Enum>())) {
    const auto known = texts.find(*wire::value_of_word<Enum>(word));
    all[word] = known == texts.end() ? word : known->second;
  }
  return all;
}

}  // namespace

ordered_json word_texts() {
  return {
      {"states", by_word(Texts<v1::JobState>{{v1::JOB_STATE_QUEUED, "waiting"},
                                             {v1::JOB_STATE_RUNNING, "running"},
                                             {v1::JOB_STATE_DONE, "done"},
                                             {v1::JOB_STATE_FAILED, "failed"},
                                             {v1::JOB_STATE_CANCELLED, "cancelled"}})},
      {"stages",
       by_word(Texts<v1::JobStage>{{v1::JOB_STAGE_PREPARE, "checking the mesh and laying the lattice"},
                                   {v1::JOB_STAGE_ERODE, "eroding"},
                                   {v1::JOB_STAGE_REFINE, "going down to the infimum"},
                                   {v1::JOB_STAGE_DERIVE, "finding the skeleton"},
                                   {v1::JOB_STAGE_COMPLETE, "complete"}})},
      {"operators", by_word(Texts<v1::Operator>{
                        {v1::OPERATOR_ZUCKER_HUMMEL, "Zucker–Hummel, as published"},
                        {v1::OPERATOR_INTERMEDIATE, "intermediate differences"},
                        {v1::OPERATOR_CENTRAL, "central differences"},
                        {v1::OPERATOR_SOBEL, "Sobel"},
                        {v1::OPERATOR_FLUX, "average outward flux"},
                        {v1::OPERATOR_CHORDS, "equal chords, joined into a sheet"},
                        {v1::OPERATOR_RIDGE, "the ridge of E: sheets, and curves where the solid is round"},
                        {v1::OPERATOR_CURVE, "the ridge, collapsed to lines through the limbs"}})},
      {"frames", by_word(Texts<v1::Frame>{{v1::FRAME_AXIS, "the axes of the mesh"},
                                          {v1::FRAME_PCA, "the principal axes of the solid"},
                                          {v1::FRAME_OBB, "the axes of its smallest box"},
                                          {v1::FRAME_AFFINE, "axes that follow affine maps"}})},
      {"minima", by_word(Texts<v1::Minimum>{{v1::MINIMUM_SET, "these directions"},
                                            {v1::MINIMUM_INFIMUM, "all, beginning from these"}})}};
}

}  // namespace affskel::client
