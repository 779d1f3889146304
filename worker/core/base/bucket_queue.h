#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace affskel::core {

/// A queue by small whole numbers that only grow from one item taken to the next (a monotone bucket queue:
/// Dial 1969).  What is put in below the number of the last item taken counts as having that one.  Items of
/// one number leave in the order in which they came.
template <class Item>
class BucketQueue {
 public:
  void push(std::size_t number, Item item) {
    number = std::max(number, current_);
    if (number >= buckets_.size()) buckets_.resize(number + 1);
    buckets_[number].push_back(std::move(item));
  }

  /// @return false when nothing is left.
  bool pop(Item& item) {
    for (; current_ < buckets_.size(); ++current_, next_ = 0) {
      std::vector<Item>& bucket = buckets_[current_];
      if (next_ < bucket.size()) {
        item = std::move(bucket[next_++]);
        return true;
      }
      std::vector<Item>().swap(bucket);
    }
    if (current_ > 0) {  // what comes now counts as having the last item's number
      --current_;
      next_ = 0;
    }
    return false;
  }

  /// Takes all items of the least number there is, in the order in which they came; what is put in with that number
  /// afterwards is taken by the next call.
  /// @return false when nothing is left.
  bool pop_all(std::vector<Item>& items) {
    items.clear();
    Item item;
    if (!pop(item)) return false;
    std::vector<Item>& bucket = buckets_[current_];
    if (next_ == 1) {  // all of it, without a copy
      bucket.front() = std::move(item);
      items.swap(bucket);
    } else {
      items.push_back(std::move(item));
      for (; next_ < bucket.size(); ++next_) items.push_back(std::move(bucket[next_]));
      bucket.clear();
    }
    next_ = 0;
    return true;
  }

  /// The number of the last item taken.
  std::size_t current() const { return current_; }

 private:
  std::vector<std::vector<Item>> buckets_;
  std::size_t current_ = 0, next_ = 0;
};

}  // namespace affskel::core
