#pragma once

#include <grpcpp/support/status.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>

#include "calls/status.h"
#include "calls/upload_budget.h"
#include "database/errors.h"

namespace affskel::server {

/// The data of an upload while they arrive.  Holds about what has come, whatever the header announced.
class Upload {
 public:
  /// @param announced bytes that the header promises; more are refused at once, not stored.
  /// @param left_over bytes of the budget that are for others.
  Upload(UploadBudget& budget, std::uint64_t announced, std::uint64_t left_over = 0)
      : announced_(announced), share_(budget, left_over) {}

  /// @throws StoreError kInvalid on too many bytes; CallEnded when other uploads fill the budget:
  ///   UNAVAILABLE, for it soon has room again.
  void add(std::string_view bytes) {
    const std::uint64_t size = data_.size() + bytes.size();
    if (size > announced_) {
      throw StoreError(StoreError::Code::kInvalid, "more data than the " + std::to_string(announced_) +
                                                       " bytes that the header announced");
    }
    if (!share_.take(bytes.size())) {
      throw CallEnded(
          {grpc::StatusCode::UNAVAILABLE, "the server is receiving as much as it can hold; try again"});
    }
    // The announced size is reserved only once part of it has arrived.
    if (size > data_.capacity()) data_.reserve(std::min(announced_, std::max(kAtFirst, kGrowth * size)));
    data_ += bytes;
  }

  /// A message of an upload after its header.
  template <typename Request>
  void add_message(const Request& message) {
    if (message.part_case() != Request::kData) {
      throw StoreError(StoreError::Code::kInvalid, "only data may follow the header of an upload");
    }
    add(message.data());
  }

  const std::string& data() const { return data_; }

 private:
  static constexpr std::uint64_t kAtFirst = 4096;
  static constexpr std::uint64_t kGrowth = 4;

  const std::uint64_t announced_;
  UploadBudget::Share share_;
  std::string data_;
};

}  // namespace affskel::server
