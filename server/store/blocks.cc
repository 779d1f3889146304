#include "store/blocks.h"

#include <algorithm>

#include "store/rows.h"
#include "store/task_rows.h"

namespace affskel::server {
namespace {

// Blocks: small enough that many workers share a job and a lost one is soon redone elsewhere, large enough
// that fetching the field for each of them does not count.
constexpr std::int64_t kLargeBlocks = 16;
constexpr std::int64_t kFineBlocks = 64;
constexpr std::int64_t kLastBlocks = 256;
constexpr std::int64_t kMinBlockPositions = 16;
constexpr std::int64_t kMinBlockPoints = 256;

// Every block costs its worker two round trips and a commit, so most of them are large; the last quarter is
// cut finer, and the last sixteenth finer still, so that no worker is left alone with a large one while the
// others have nothing to do.
std::vector<Range> cut(std::int64_t count, std::int64_t least) {
  const auto part = [&](std::int64_t parts) { return std::max(least, (count + parts - 1) / parts); };
  const std::int64_t fine_from = count / 4 * 3, last_from = count / 16 * 15;
  std::vector<Range> blocks;
  for (std::int64_t begin = 0; begin < count;) {
    const std::int64_t parts = begin < fine_from   ? kLargeBlocks
                               : begin < last_from ? kFineBlocks
                                                   : kLastBlocks;
    blocks.push_back({begin, std::min(count, begin + part(parts))});
    begin = blocks.back().end;
  }
  return blocks;
}

}  // namespace

void cut_blocks(Tx& tx, const std::string& job_id, std::int64_t directions) {
  for (const Range& block : cut(directions, kMinBlockPositions)) add_block(tx, job_id, block);
}

void cut_point_blocks(Tx& tx, const std::string& job_id, std::int64_t round, std::int64_t points,
                      const std::vector<std::uint32_t>* changed) {
  const std::int64_t count = changed == nullptr ? points : static_cast<std::int64_t>(changed->size());
  std::int64_t begin = 0;
  for (const Range& block : cut(count, kMinBlockPoints)) {
    const bool last = block.end == count;
    const std::int64_t end = last                 ? points
                             : changed == nullptr ? block.end
                                                  : (*changed)[static_cast<std::size_t>(block.end)];
    add_point_block(tx, job_id, round, {begin, end});
    begin = end;
  }
}

}  // namespace affskel::server
