#include "tally.h"

#include <algorithm>
#include <iomanip>
#include <sstream>

namespace affskel::chaos {
namespace {

void print(std::ostream& out, const std::string& kind, const Outcome& outcome) {
  out << "| " << std::left << std::setw(24) << kind << std::right;
  for (const std::uint64_t number : {outcome.injected, outcome.without_effect, outcome.differing,
                                     outcome.lost, outcome.hangs, outcome.unclean, outcome.deaths}) {
    out << " | " << std::setw(6) << number;
  }
  out << " | " << std::setw(6);
  if (outcome.recoveries == 0) {
    out << "-";
  } else {
    out << outcome.recovery.count() / static_cast<std::int64_t>(outcome.recoveries);
  }
  out << " |\n";
}

}  // namespace

Outcome& Outcome::operator+=(const Outcome& other) {
  injected += other.injected;
  without_effect += other.without_effect;
  differing += other.differing;
  lost += other.lost;
  hangs += other.hangs;
  unclean += other.unclean;
  deaths += other.deaths;
  recoveries += other.recoveries;
  recovery += other.recovery;
  return *this;
}

void Tally::add(const std::string& kind, const Outcome& outcome) {
  auto row = std::find_if(rows_.begin(), rows_.end(), [&](const Row& known) { return known.kind == kind; });
  if (row == rows_.end()) row = rows_.insert(rows_.end(), {kind, {}});
  row->outcome += outcome;
}

Outcome Tally::total() const {
  Outcome sum;
  for (const Row& row : rows_) sum += row.outcome;
  return sum;
}

std::string Tally::table() const {
  std::ostringstream out;
  out << "| kind                     | faults | no eff | differ |   lost |  hangs | uncln  | deaths | rec/ms "
         "|\n"
      << "|--------------------------|-------:|-------:|-------:|-------:|-------:|-------:|-------:|-------:"
         "|\n";
  for (const Row& row : rows_) print(out, row.kind, row.outcome);
  print(out, "total", total());
  return out.str();
}

}  // namespace affskel::chaos
