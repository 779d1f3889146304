#include "client/text/verification_text.h"

#include <map>

#include "base/number_text.h"
#include "client/text/key_line.h"
#include "client/text/printable.h"

namespace affskel::client {
namespace {

std::string name_of(const v1::Giver& giver) {
  return one_line(giver.worker()) + (giver.host().empty() ? "" : " on " + one_line(giver.host()));
}

/// The workers that gave the directions of a sample: one of them, where work was repeated.
std::string givers_text(const v1::VerifiedSample& sample) {
  std::string text;
  for (const v1::Giver& giver : sample.givers()) text += (text.empty() ? "" : " or ") + name_of(giver);
  return text.empty() ? "not kept" : text;
}

struct Sum {
  std::uint64_t directions = 0;
  std::uint64_t compared = 0;
  std::uint64_t differing = 0;
  std::uint64_t failed = 0;
  std::string verifier;

  void add(const v1::VerifiedSample& sample) {
    directions += sample.directions();
    compared += sample.compared();
    differing += sample.differing();
    failed += sample.failed() ? sample.directions() : 0;
    if (!sample.verifier().worker().empty()) verifier = name_of(sample.verifier());
  }
};

std::string sum_text(const Sum& sum) {
  std::string text =
      base::counted(sum.directions, "direction") + ", " + base::counted(sum.compared, "value") +
      " compared, " +
      (sum.differing == 0 ? "no difference" : base::counted(sum.differing, "point") + " differ");
  if (sum.failed > 0) text += ", " + base::counted(sum.failed, "direction") + " not computed";
  if (!sum.verifier.empty()) text += "; computed again by " + sum.verifier;
  return text;
}

}  // namespace

std::string verification_details(const v1::Verification& verification) {
  Sum all;
  std::map<std::string, Sum> by_giver;
  for (const v1::VerifiedSample& sample : verification.samples()) {
    all.add(sample);
    by_giver[givers_text(sample)].add(sample);
  }
  std::string text = key_line("job", verification.job()) +
                     key_line("directions", std::to_string(all.directions)) +
                     key_line("compared", std::to_string(all.compared)) +
                     key_line("differing", std::to_string(all.differing));
  for (const auto& [giver, sum] : by_giver) text += key_line("worker", giver + ": " + sum_text(sum));
  return text;
}

const v1::VerifiedSample* first_differing(const v1::Verification& verification) {
  for (const v1::VerifiedSample& sample : verification.samples())
    if (sample.differing() > 0) return &sample;
  return nullptr;
}

std::string difference_text(const v1::VerifiedSample& sample) {
  return "what worker " + givers_text(sample) +
         " gave is not what another computed: " + one_line(sample.message());
}

std::string gap_text(const v1::Verification& verification) {
  for (const v1::VerifiedSample& sample : verification.samples()) {
    if (sample.failed()) return "not all of the sample was computed again: " + one_line(sample.message());
  }
  return {};
}

}  // namespace affskel::client
