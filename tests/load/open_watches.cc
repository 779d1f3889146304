#include "open_watches.h"

#include <future>

namespace affskel::load {
namespace {

constexpr int kPerConnection = 40;

}  // namespace

class OpenWatches::Watch final : public grpc::ClientReadReactor<v1::Job> {
 public:
  Watch(v1::ErosionService::Stub& stub, const std::string& id, Calls& calls)
      : calls_(calls), start_(std::chrono::steady_clock::now()) {
    request_.set_job(id);
    stub.async()->WatchJob(&context_, &request_, this);
    StartRead(&job_);
    StartCall();
  }

  void cancel() { context_.TryCancel(); }
  void wait() { ended_.get_future().wait(); }

  void OnReadDone(bool read) override {
    if (!read) return;
    if (first_) calls_.add("watch", std::chrono::steady_clock::now() - start_, grpc::Status::OK);
    first_ = false;
    StartRead(&job_);
  }

  void OnDone(const grpc::Status& status) override {
    const bool ours = status.ok() || status.error_code() == grpc::StatusCode::CANCELLED;
    if (!ours) calls_.add("watch", std::chrono::steady_clock::now() - start_, status);
    ended_.set_value();
  }

 private:
  Calls& calls_;
  const std::chrono::steady_clock::time_point start_;
  grpc::ClientContext context_;
  v1::WatchJobRequest request_;
  v1::Job job_;
  bool first_ = true;
  std::promise<void> ended_;
};

OpenWatches::OpenWatches(const std::string& address, const std::vector<std::string>& ids, int number,
                         Calls& calls) {
  for (int i = 0; i < number; ++i) {
    if (i % kPerConnection == 0) stubs_.push_back(v1::ErosionService::NewStub(connect(address)));
    const std::string& id = ids[static_cast<std::size_t>(i) % ids.size()];
    watches_.push_back(std::make_unique<Watch>(*stubs_.back(), id, calls));
  }
}

OpenWatches::~OpenWatches() {
  for (const auto& watch : watches_) watch->cancel();
  for (const auto& watch : watches_) watch->wait();
}

}  // namespace affskel::load
