#include "store/blocks.h"

#include <algorithm>

#include "store/task_rows.h"

namespace affskel::server {
namespace {

// Blocks: small enough that many workers share a job and a lost one is soon redone elsewhere, large enough
// that fetching the field for each of them does not count.
constexpr std::int64_t kLargeBlocks = 16;
constexpr std::int64_t kFineBlocks = 64;
constexpr std::int64_t kLastBlocks = 256;
constexpr std::int64_t kMinBlockPositions = 16;

}  // namespace

// Every block costs its worker two round trips and a commit, so most of them are large; the last quarter is
// cut finer, and the last sixteenth finer still, so that no worker is left alone with a large one while the
// others have nothing to do.
void cut_blocks(Tx& tx, const std::string& job_id, std::int64_t directions) {
  const auto part = [&](std::int64_t parts) {
    return std::max(kMinBlockPositions, (directions + parts - 1) / parts);
  };
  const std::int64_t fine_from = directions / 4 * 3, last_from = directions / 16 * 15;
  for (std::int64_t begin = 0; begin < directions;) {
    const std::int64_t parts = begin < fine_from   ? kLargeBlocks
                               : begin < last_from ? kFineBlocks
                                                   : kLastBlocks;
    const std::int64_t end = std::min(directions, begin + part(parts));
    add_block(tx, job_id, {begin, end});
    begin = end;
  }
}

}  // namespace affskel::server
