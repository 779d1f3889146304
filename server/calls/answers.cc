#include "calls/answers.h"

#include <string>
#include <vector>

#include "calls/status.h"

namespace affskel::server {

void Answers::check(const Caller& caller) const {
  const base::MutexLock lock(mutex_);
  const auto reader = readers_.find(caller.connection);
  // A peer that reads what it asks for is not refused for others that do not, unless these are very many.
  const std::uint64_t own = reader == readers_.end() ? 0 : reader->second.bytes;
  if (own < options_.of_connection && bytes_ < (own < options_.little ? 2 : 1) * options_.of_all) return;
  throw CallEnded({grpc::StatusCode::UNAVAILABLE,
                   std::to_string(own) + " bytes of answers wait to be read on this connection, " +
                       std::to_string(bytes_) + " on all; read them, and try again"});
}

Answers::Answer Answers::enter(const Caller& caller, std::uint64_t bytes, std::weak_ptr<Endable> call) {
  const std::uint64_t taken = taken_(caller.connection).value_or(0);
  const base::MutexLock lock(mutex_);
  const auto [found, is_new] = readers_.try_emplace(caller.connection);
  Reader& reader = found->second;
  if (is_new) {
    reader.taken = taken;
    reader.pace = base::Pace(options_.pace);
    reader.pace.turn(options_.now());
  }
  reader.bytes += bytes;
  ++reader.answers;
  bytes_ += bytes;
  const std::uint64_t number = next_number_++;
  answers_.emplace(number, Entry{caller.connection, bytes, std::move(call)});
  return {this, number};
}

void Answers::leave(std::uint64_t number) {
  const base::MutexLock lock(mutex_);
  const auto answer = answers_.find(number);
  if (answer == answers_.end()) return;
  const auto reader = readers_.find(answer->second.connection);
  reader->second.bytes -= answer->second.bytes;
  bytes_ -= answer->second.bytes;
  if (--reader->second.answers == 0) readers_.erase(reader);
  answers_.erase(answer);
}

bool Answers::is_late(std::uint64_t connection, Reader& reader) const {
  const base::Pace::Time now = options_.now();
  const std::uint64_t taken = taken_(connection).value_or(reader.taken);
  if (taken > reader.taken) {
    reader.pace.moved(taken - reader.taken, now);
    reader.pace.turn(now);
    reader.taken = taken;
  }
  return reader.pace.late(now);
}

void Answers::tick() {
  std::vector<std::weak_ptr<Endable>> late;
  {
    const base::MutexLock lock(mutex_);
    std::map<std::uint64_t, bool> by_connection;
    for (auto& [connection, reader] : readers_) by_connection[connection] = is_late(connection, reader);
    for (const auto& [number, answer] : answers_) {
      if (by_connection[answer.connection]) late.push_back(answer.call);
    }
  }
  for (const auto& call : late) {
    if (const auto alive = call.lock())
      alive->end({grpc::StatusCode::UNAVAILABLE, "the answer was not read for too long"});
  }
}

std::uint64_t Answers::bytes() const {
  const base::MutexLock lock(mutex_);
  return bytes_;
}

}  // namespace affskel::server
