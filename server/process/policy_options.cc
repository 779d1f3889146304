#include "process/policy_options.h"

#include <charconv>
#include <cstdint>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <system_error>

#include "base/quoted.h"

namespace affskel::server {
namespace {

enum class Unit { kCount, kBytes, kAge };

struct Entry {
  const std::string& text;  // as written
  std::string_view owner;   // empty = everyone
  std::string_view name;
  std::string_view value;
};

[[noreturn]] void refuse_entry(const Entry& entry, const std::string& why) {
  throw std::invalid_argument(base::quoted(entry.text) + ": " + why);
}

/// [OWNER:]NAME=VALUE: owners may have any signs in their names, names and values not.
Entry split(const std::string& text) {
  const std::string_view all = text;
  const std::size_t equals = all.rfind('=');
  if (equals == std::string_view::npos) refuse_entry({text, {}, {}, {}}, "expected [OWNER:]NAME=VALUE");
  const std::string_view left = all.substr(0, equals), value = all.substr(equals + 1);
  const std::size_t colon = left.rfind(':');
  if (colon == std::string_view::npos) return {text, {}, left, value};
  return {text, left.substr(0, colon), left.substr(colon + 1), value};
}

/// What a suffix stands for; nothing for one that the unit does not have.
std::optional<std::int64_t> factor(Unit unit, std::string_view suffix) {
  struct Suffix {
    const char* text;
    std::int64_t count, bytes, ms;  // 0 = not of this unit
  };
  constexpr std::int64_t kKilo = 1000, kKibi = 1024;
  constexpr Suffix kSuffixes[] = {
      {"", 1, 1, 0},
      {"K", kKilo, kKibi, 0},
      {"M", kKilo * kKilo, kKibi * kKibi, 0},
      {"G", kKilo * kKilo * kKilo, kKibi * kKibi * kKibi, 0},
      {"T", kKilo * kKilo * kKilo * kKilo, kKibi * kKibi * kKibi * kKibi, 0},
      {"s", 0, 0, 1000},
      {"h", 0, 0, std::int64_t{3600} * 1000},
      {"d", 0, 0, std::int64_t{24} * 3600 * 1000},
  };
  for (const Suffix& known : kSuffixes) {
    if (suffix != known.text) continue;
    const std::int64_t value = unit == Unit::kCount   ? known.count
                               : unit == Unit::kBytes ? known.bytes
                                                      : known.ms;
    if (value != 0) return value;
  }
  return std::nullopt;
}

std::int64_t value_of(const Entry& entry, Unit unit) {
  std::int64_t number = 0;
  const char* end = entry.value.data() + entry.value.size();
  const auto [rest, problem] = std::from_chars(entry.value.data(), end, number);
  const std::string_view suffix(rest, static_cast<std::size_t>(end - rest));
  if (unit == Unit::kAge && entry.value == "0") return 0;
  const std::optional<std::int64_t> times = factor(unit, suffix);
  if (problem != std::errc() || number < 0 || !times ||
      number > std::numeric_limits<std::int64_t>::max() / 2 / *times) {
    refuse_entry(entry, unit == Unit::kAge ? "expected an age such as 90d, 12h or 30s"
                                           : "expected a whole number >= 0, such as 500 or 20G (K, M, G, T)");
  }
  return number * *times;
}

template <typename Settings>
struct Name {
  const char* name;
  std::int64_t Settings::*place;
  Unit unit;
};

constexpr Name<Quota> kQuotas[] = {{"queued-jobs", &Quota::queued_jobs, Unit::kCount},
                                   {"mesh-bytes", &Quota::mesh_bytes, Unit::kBytes},
                                   {"stored-bytes", &Quota::stored_bytes, Unit::kBytes},
                                   {"chords", &Quota::chords, Unit::kCount}};
constexpr Name<Retention> kRetentions[] = {{"results-age", &Retention::results_age_ms, Unit::kAge},
                                           {"jobs-age", &Retention::jobs_age_ms, Unit::kAge},
                                           {"stored-bytes", &Retention::stored_bytes, Unit::kBytes}};
constexpr Name<Policy> kOfServer[] = {{"total-bytes", &Policy::total_bytes, Unit::kBytes},
                                      {"grace", &Policy::grace_ms, Unit::kAge}};

/// False when the entry has none of these names.
template <typename Settings, std::size_t count>
bool set(Settings& settings, const Entry& entry, const Name<Settings> (&names)[count]) {
  for (const Name<Settings>& known : names) {
    if (entry.name != known.name) continue;
    settings.*(known.place) = value_of(entry, known.unit);
    return true;
  }
  return false;
}

OwnerPolicy& policy_of(Policy& policy, const Entry& entry) {
  if (entry.owner.empty()) return policy.everyone;
  return policy.owners.try_emplace(std::string(entry.owner), policy.everyone).first->second;
}

void set_limit(Policy& policy, const Entry& entry) {
  if (!entry.owner.empty()) refuse_entry(entry, "a limit is of the server, not of an owner: that is a quota");
  if (!set(policy.server, entry, kQuotas)) {
    refuse_entry(entry, "expected queued-jobs, mesh-bytes, stored-bytes or chords");
  }
}

/// 0 .. 9, without a suffix.
std::int64_t priority_of(const Entry& entry) {
  if (entry.value.size() != 1 || entry.value[0] < '0' || entry.value[0] > '9') {
    refuse_entry(entry, "expected a priority 0 .. 9");
  }
  return entry.value[0] - '0';
}

void set_quota(Policy& policy, const Entry& entry) {
  if (entry.name == "priority") {
    policy_of(policy, entry).priority = priority_of(entry);
    return;
  }
  if (!set(policy_of(policy, entry).quota, entry, kQuotas)) {
    refuse_entry(entry, "expected queued-jobs, mesh-bytes, stored-bytes, chords or priority");
  }
}

void set_retention(Policy& policy, const Entry& entry) {
  if (entry.owner.empty() && set(policy, entry, kOfServer)) return;
  if (!set(policy_of(policy, entry).retention, entry, kRetentions)) {
    refuse_entry(entry,
                 "expected results-age, jobs-age or stored-bytes, or without an owner total-bytes or grace");
  }
}

}  // namespace

Policy parse_policy(const PolicyWords& words) {
  Policy policy;
  for (const std::string& word : words.limits) set_limit(policy, split(word));
  // Owners begin with what holds for everyone, so that comes first.
  for (const bool of_owners : {false, true}) {
    for (const std::string& word : words.quotas) {
      if (const Entry entry = split(word); entry.owner.empty() != of_owners) set_quota(policy, entry);
    }
    for (const std::string& word : words.retentions) {
      if (const Entry entry = split(word); entry.owner.empty() != of_owners) set_retention(policy, entry);
    }
  }
  return policy;
}

}  // namespace affskel::server
