#include "database/reader_pool.h"
#include "base/mutex.h"

namespace affskel::server {
namespace {

// Connections kept open: as many as are used at once on most machines.  Each keeps a few descriptors and a
// cache of 256 KiB.
constexpr std::size_t kMaxIdle = 8;

}  // namespace

std::unique_ptr<Database> ReaderPool::take() {
  {
    const base::MutexLock lock(mutex_);
    if (!idle_.empty()) {
      std::unique_ptr<Database> db = std::move(idle_.back());
      idle_.pop_back();
      return db;
    }
  }
  return std::make_unique<Database>(file_, Database::Mode::kReadOnly);
}

void ReaderPool::give_back(std::unique_ptr<Database> db) {
  // Where memory ran out, a read may not have ended: the next would see what was there at that time.
  if (!db->is_at_rest()) return;
  const base::MutexLock lock(mutex_);
  if (idle_.size() < kMaxIdle) idle_.push_back(std::move(db));
}

}  // namespace affskel::server
