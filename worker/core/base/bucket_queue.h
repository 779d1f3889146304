#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <memory>
#include <utility>
#include <vector>

namespace affskel::core {

/// A queue by small whole numbers that only grow from one item taken to the next (a monotone bucket queue:
/// Dial 1969).  What is put in below the number of the last item taken counts as having that one.  Items of
/// one number leave in the order in which they came.  Buckets are lists of small blocks that are used again: as
/// arrays that double they would be the largest of a collapse.  There is a ring of them for the next kNear numbers, and a
/// map for what lies farther: an array would have one for each number up to the greatest, with items or not.
template <class Item>
class BucketQueue {
 public:
  void push(std::size_t number, Item item) {
    number = std::max(number, current_);
    const bool is_near = number - current_ < kNear;
    Bucket& bucket = is_near ? near(number) : far_[number];
    if (is_near) ++near_items_;
    const std::size_t place = bucket.end % kItems;
    if (place == 0) append_block(bucket);
    bucket.last->items[place] = std::move(item);
    ++bucket.end;
  }

  /// @return false when nothing is left.
  bool pop(Item& item) {
    if (!find_next()) return false;
    Bucket& bucket = near(current_);
    --near_items_;
    item = std::move(first_of(bucket));
    take_from(bucket);
    return true;
  }

  /// Takes all items of the least number there is: a wave.  What is put in with that number afterwards is of the next one.
  /// @param wave these, in the order in which they came, instead of what it had.
  /// @return false when nothing is left.
  bool pop_wave(std::vector<Item>& wave) {
    wave.clear();
    if (!find_next()) return false;
    Bucket& bucket = near(current_);
    near_items_ -= bucket.end - bucket.begin;
    wave.reserve(bucket.end - bucket.begin);
    for (; bucket.begin < bucket.end; take_from(bucket)) wave.push_back(std::move(first_of(bucket)));
    clear(bucket);
    return true;
  }

  /// The number of the last item taken.
  std::size_t current() const { return current_; }

  static constexpr std::size_t kNear = 4096;

 private:
  static constexpr std::size_t kItems = 8, kBlocks = 256;  // of a block, and blocks made at a time

  struct Block {
    std::array<Item, kItems> items{};
    Block* next = nullptr;
  };
  using Blocks = std::array<Block, kBlocks>;
  // Items begin .. end - 1, counted from the first block of all that it had; those before have gone.
  struct Bucket {
    Block *first = nullptr, *last = nullptr;
    std::size_t begin = 0, end = 0;
  };

  Bucket& near(std::size_t number) { return near_[number % kNear]; }

  // Goes on to the first bucket that has an item.
  bool find_next() {
    while (near(current_).begin == near(current_).end) {
      clear(near(current_));
      if (near_items_ == 0 && far_.empty()) return false;
      current_ = near_items_ > 0 ? current_ + 1 : far_.begin()->first;
      for (; !far_.empty() && far_.begin()->first - current_ < kNear; far_.erase(far_.begin())) {
        const auto& [number, bucket] = *far_.begin();
        near_items_ += bucket.end;
        near(number) = bucket;
      }
    }
    return true;
  }

  Item& first_of(Bucket& bucket) { return bucket.first->items[bucket.begin % kItems]; }
  void take_from(Bucket& bucket) {
    if (++bucket.begin % kItems == 0) drop_block(bucket);
  }

  void append_block(Bucket& bucket) {
    if (unused_ == nullptr) {
      store_.push_back(std::make_unique<Blocks>());
      for (Block& block : *store_.back()) block.next = std::exchange(unused_, &block);
    }
    Block* const block = std::exchange(unused_, unused_->next);
    block->next = nullptr;
    (bucket.first == nullptr ? bucket.first : bucket.last->next) = block;
    bucket.last = block;
  }

  void drop_block(Bucket& bucket) {
    Block* const block = std::exchange(bucket.first, bucket.first->next);
    block->next = std::exchange(unused_, block);
  }

  void clear(Bucket& bucket) {
    while (bucket.first != nullptr) drop_block(bucket);
    bucket = {};
  }

  std::vector<std::unique_ptr<Blocks>> store_;
  Block* unused_ = nullptr;
  std::vector<Bucket> near_ =
      std::vector<Bucket>(kNear);  // of current_ .. current_ + kNear - 1, by their remainders
  std::size_t near_items_ = 0;
  std::map<std::size_t, Bucket> far_;
  std::size_t current_ = 0;
};

}  // namespace affskel::core
