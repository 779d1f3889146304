#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <utility>

#include "base/mutex.h"
#include "base/pace.h"
#include "calls/call_limit.h"

namespace affskel::server {

struct AnswerOptions {
  std::uint64_t of_connection = std::uint64_t{32} << 20;  ///< bytes that one connection may leave unread
  std::uint64_t of_all = std::uint64_t{192} << 20;        ///< all of them ...
  std::uint64_t little = std::uint64_t{1}
                         << 20;  ///< ... and as much again, of those that leave less than this
  base::PaceOptions pace;        ///< at which a connection must take answers while some wait
  std::function<std::chrono::steady_clock::time_point()> now = [] {
    return std::chrono::steady_clock::now();
  };
};

/// The answers that gRPC has been given and has not sent yet, which it keeps for as long as a client opens no
/// window for them.  Thread-safe.
class Answers {
 public:
  /// Bytes of messages that the peer of a connection has taken so far; nothing when it is closed.
  using Taken = std::function<std::optional<std::uint64_t>(std::uint64_t connection)>;

  Answers(AnswerOptions options, Taken taken) : options_(std::move(options)), taken_(std::move(taken)) {}
  Answers(const Answers&) = delete;
  Answers& operator=(const Answers&) = delete;

  /// One answer, until it is destroyed: gRPC has sent it, or given it up.
  class Answer {
   public:
    Answer() = default;
    Answer(Answer&& other) noexcept
        : answers_(std::exchange(other.answers_, nullptr)), number_(other.number_) {}
    Answer& operator=(Answer&&) = delete;
    ~Answer() { leave(); }
    void leave() {
      if (answers_ != nullptr) std::exchange(answers_, nullptr)->leave(number_);
    }

   private:
    friend class Answers;
    Answer(Answers* answers, std::uint64_t number) : answers_(answers), number_(number) {}
    Answers* answers_ = nullptr;
    std::uint64_t number_ = 0;
  };

  /// Before an answer is made.
  /// @throws CallEnded UNAVAILABLE when too much is unread already.
  void check(const Caller& caller) const;

  /// An answer is about to be given to gRPC.
  /// @param bytes of memory that it takes.
  /// @param call is ended when its peer takes too little for too long.
  Answer enter(const Caller& caller, std::uint64_t bytes, std::weak_ptr<Endable> call);

  /// Ends the calls whose peers take too little.  Call now and then.
  void tick();

  /// Bytes that wait.
  std::uint64_t bytes() const;

 private:
  struct Entry {
    std::uint64_t connection;
    std::uint64_t bytes;
    std::weak_ptr<Endable> call;
  };
  struct Reader {
    std::uint64_t bytes = 0;
    std::size_t answers = 0;
    std::uint64_t taken = 0;  // at the last look
    base::Pace pace;
  };

  void leave(std::uint64_t number);
  bool is_late(std::uint64_t connection, Reader& reader) const ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);

  const AnswerOptions options_;
  const Taken taken_;
  mutable base::Mutex mutex_;
  std::map<std::uint64_t, Entry> answers_ ABSL_GUARDED_BY(mutex_);   // by the order of their coming
  std::map<std::uint64_t, Reader> readers_ ABSL_GUARDED_BY(mutex_);  // by connection: those with answers
  std::uint64_t bytes_ ABSL_GUARDED_BY(mutex_) = 0;
  std::uint64_t next_number_ ABSL_GUARDED_BY(mutex_) = 1;
};

}  // namespace affskel::server
