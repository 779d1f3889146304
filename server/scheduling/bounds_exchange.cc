#include "scheduling/bounds_exchange.h"

#include <algorithm>

#include "base/mutex.h"
#include "wire/erosion_bound.h"

namespace affskel::server {
namespace {

constexpr std::size_t kPointBytes = 8;
constexpr std::size_t kEntryBytes = 512;

std::size_t memory_of(const v1::ErosionBounds& message) {
  return kEntryBytes + kPointBytes * static_cast<std::size_t>(message.step_size());
}

}  // namespace

void BoundsExchange::join(const std::string& field, const std::string& worker) {
  const base::MutexLock lock(mutex_);
  enter(field, worker);
}

void BoundsExchange::exchange(const std::string& field, const std::string& worker,
                              const std::vector<wire::PointRecord>& records, std::size_t room,
                              v1::ReportResponse& response) {
  std::vector<Message> theirs;
  {
    const base::MutexLock lock(mutex_);
    if (!enter(field, worker)) return;
    theirs = collect(field, worker, room);
  }
  const std::vector<Message> ours = pack(records);
  {
    const base::MutexLock lock(mutex_);
    keep(field, worker, ours);
  }
  for (const Message& message : theirs) *response.add_bounds() = *message;
}

void BoundsExchange::pass_on(const std::string& field, const std::string& worker,
                             const std::vector<wire::PointRecord>& records) {
  {
    const base::MutexLock lock(mutex_);
    if (!enter(field, worker)) return;
  }
  const std::vector<Message> ours = pack(records);
  const base::MutexLock lock(mutex_);
  keep(field, worker, ours);
}

std::vector<BoundsExchange::Message> BoundsExchange::pack(
    const std::vector<wire::PointRecord>& records) const {
  const auto in_order = [](const wire::PointRecord& a, const wire::PointRecord& b) {
    return a.point < b.point;
  };
  if (!std::is_sorted(records.begin(), records.end(), in_order)) return {};
  std::vector<Message> messages;
  for (std::size_t begin = 0; begin < records.size(); begin += options_.message_points) {
    const std::size_t end = std::min(begin + options_.message_points, records.size());
    const auto message = std::make_shared<v1::ErosionBounds>();
    message->mutable_step()->Reserve(static_cast<int>(end - begin));
    message->mutable_bound()->Reserve(static_cast<int>(end - begin));
    std::uint32_t before = 0;
    for (std::size_t i = begin; i < end; ++i) {
      message->add_step(records[i].point - before);
      message->add_bound(wire::bound_above(records[i].erosion));
      before = records[i].point;
    }
    messages.push_back(message);
  }
  return messages;
}

/// Notes the worker of a field; whether it has company.
bool BoundsExchange::enter(const std::string& field, const std::string& worker) {
  if (seen_.size() >= options_.fields && !seen_.contains(field)) seen_.clear();
  auto& workers = seen_[field];
  if (workers.size() >= options_.workers && !workers.contains(worker)) workers.clear();
  workers.try_emplace(worker, forgotten_ + entries_.size());
  return workers.size() > 1;
}

std::vector<BoundsExchange::Message> BoundsExchange::collect(const std::string& field,
                                                             const std::string& worker, std::size_t room) {
  std::uint64_t& next = seen_[field][worker];
  next = std::max(next, forgotten_);
  std::vector<Message> messages;
  std::size_t bytes = 0;
  for (; next < forgotten_ + entries_.size(); ++next) {
    const Entry& entry = entries_[next - forgotten_];
    if (entry.message == nullptr || entry.field != field || entry.worker == worker) continue;
    bytes += entry.wire_bytes;
    if (bytes > room && !messages.empty()) break;
    messages.push_back(entry.message);
  }
  return messages;
}

void BoundsExchange::keep(const std::string& field, const std::string& worker,
                          const std::vector<Message>& messages) {
  for (const Message& message : messages) {
    entries_.push_back({field, worker, message, memory_of(*message), message->ByteSizeLong()});
    bytes_ += entries_.back().bytes;
  }
  while (bytes_ > options_.kept_bytes) drop_first();
}

void BoundsExchange::drop_first() {
  if (entries_.front().message == nullptr) --dead_;
  bytes_ -= entries_.front().bytes;
  entries_.pop_front();
  ++forgotten_;
}

void BoundsExchange::forget(const std::string& field) {
  const base::MutexLock lock(mutex_);
  seen_.erase(field);
  for (Entry& entry : entries_) {
    if (entry.message == nullptr || entry.field != field) continue;
    bytes_ -= entry.bytes;
    entry = {};
    ++dead_;
  }
  while (!entries_.empty() && entries_.front().message == nullptr) drop_first();
  if (dead_ > entries_.size() / 2) close_ranks();
}

/// Removes the forgotten entries, which stand between those of a field that goes on; the others get new
/// numbers.
void BoundsExchange::close_ranks() {
  std::vector<std::uint64_t> before{0};  // entries that stay, before each
  for (const Entry& entry : entries_) before.push_back(before.back() + (entry.message != nullptr ? 1 : 0));
  for (auto& [field, workers] : seen_) {
    for (auto& [worker, next] : workers) {
      const std::uint64_t at = std::max(next, forgotten_) - forgotten_;
      next = forgotten_ + before[static_cast<std::size_t>(at)];
    }
  }
  std::erase_if(entries_, [](const Entry& entry) { return entry.message == nullptr; });
  dead_ = 0;
}

std::size_t BoundsExchange::kept() const {
  const base::MutexLock lock(mutex_);
  return entries_.size() - dead_;
}

}  // namespace affskel::server
