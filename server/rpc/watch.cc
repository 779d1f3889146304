#include "rpc/watch.h"

#include <utility>

namespace affskel::server {
namespace {

bool is_final(const v1::Job& job) {
  return job.state() == v1::JOB_STATE_DONE || job.state() == v1::JOB_STATE_FAILED ||
         job.state() == v1::JOB_STATE_CANCELLED;
}

class Refused final : public grpc::ServerWriteReactor<v1::Job> {
 public:
  explicit Refused(const grpc::Status& status) { Finish(status); }
  void OnDone() override { delete this; }
};

}  // namespace

grpc::ServerWriteReactor<v1::Job>* refused_watch(const grpc::Status& status) {
  return new Refused(status);
}

/// One stream.  At most one message is on its way; what changes meanwhile is sent next, newest only.
class Watches::Stream final : public grpc::ServerWriteReactor<v1::Job>,
                              public std::enable_shared_from_this<Stream> {
 public:
  explicit Stream(Watches& watches) : watches_(watches), call_(watches.activity_) {}

  void start(const std::string& job_id) {
    subscription_ = watches_.hub_.subscribe(
        job_id,
        [weak = weak_from_this()](const EventHub::JobPtr& job) {
          if (const std::shared_ptr<Stream> stream = weak.lock()) stream->deliver(job);
        },
        true);
  }

  void deliver(const EventHub::JobPtr& job) {
    const std::lock_guard lock(mutex_);
    if (ending_) return;
    if (job == nullptr) {
      end(grpc::Status(grpc::StatusCode::NOT_FOUND, "the job was deleted"));
      return;
    }
    next_ = job;
    if (!writing_) write();
  }

  void stop(const grpc::Status& status) {
    const std::lock_guard lock(mutex_);
    if (!ending_) end(status);
  }

  void OnWriteDone(bool ok) override {
    const std::lock_guard lock(mutex_);
    writing_ = false;
    if (ending_) {
      Finish(status_);
    } else if (!ok) {
      end(grpc::Status::CANCELLED);
    } else if (next_ != nullptr) {
      write();
    } else if (is_final(*current_)) {
      end(grpc::Status::OK);
    }
  }

  void OnCancel() override { stop(grpc::Status::CANCELLED); }

  void OnDone() override {
    const std::shared_ptr<Stream> self = shared_from_this();
    const std::lock_guard lock(watches_.mutex_);
    watches_.streams_.erase(self);
  }

 private:
  // Both are called with mutex_ held.
  void write() {
    current_ = std::move(next_);
    next_ = nullptr;
    writing_ = true;
    StartWrite(current_.get());
  }

  void end(const grpc::Status& status) {
    ending_ = true;
    status_ = status;
    if (!writing_) Finish(status_);  // otherwise when the write is over
  }

  Watches& watches_;
  Activity::Call call_;
  EventHub::Subscription subscription_;
  std::mutex mutex_;
  EventHub::JobPtr current_;
  EventHub::JobPtr next_;
  bool writing_ = false;
  bool ending_ = false;
  grpc::Status status_;
};

Watches::Watches(EventHub& hub, Activity& activity, std::size_t most)
    : hub_(hub), activity_(activity), most_(most) {}

grpc::ServerWriteReactor<v1::Job>* Watches::watch(const std::string& job_id) {
  const auto stream = std::make_shared<Stream>(*this);
  {
    const std::lock_guard lock(mutex_);
    if (stopping_) return refused_watch({grpc::StatusCode::UNAVAILABLE, "the server is shutting down"});
    if (streams_.size() >= most_) {
      return refused_watch({grpc::StatusCode::UNAVAILABLE,
                            std::to_string(most_) +
                                " watches are under way, the most that this server has at once; try again"});
    }
    streams_.insert(stream);
  }
  stream->start(job_id);
  return stream.get();
}

void Watches::stop() {
  std::set<std::shared_ptr<Stream>> streams;
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
    streams = streams_;
  }
  for (const auto& stream : streams)
    stream->stop({grpc::StatusCode::UNAVAILABLE, "the server is shutting down"});
}

}  // namespace affskel::server
