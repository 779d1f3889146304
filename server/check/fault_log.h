#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <utility>

namespace affskel::server {

/// Something about a database that must not be.
struct Fault {
  std::string where;  ///< "job ...", "erosion 3, field chunk 7", "database"
  std::string what;
};

using FaultHandler = std::function<void(const Fault&)>;

/// Passes faults on, of each kind only the first ones and then the number of the rest: there may be one for
/// every row of a table.
class FaultLog {
 public:
  FaultLog(FaultHandler handler, std::int64_t most_of_a_kind)
      : handler_(std::move(handler)), most_of_a_kind_(most_of_a_kind) {}

  void add(std::string where, std::string what) {
    ++count_;
    if (++of_this_kind_ <= most_of_a_kind_) handler_({std::move(where), std::move(what)});
  }

  /// What follows is of another kind, or there is nothing left to follow.
  void end_kind() {
    const std::int64_t untold = of_this_kind_ - most_of_a_kind_;
    if (untold > 0) handler_({"database", std::to_string(untold) + " more of this kind"});
    of_this_kind_ = 0;
  }

  /// All of them, the untold ones, too.
  std::int64_t count() const { return count_; }

 private:
  FaultHandler handler_;
  std::int64_t most_of_a_kind_;
  std::int64_t count_ = 0;
  std::int64_t of_this_kind_ = 0;
};

}  // namespace affskel::server
