#include "load.h"

namespace affskel::chaos {
namespace {

constexpr Milliseconds kLoadCall{1500};

}  // namespace

Load::Load(Scene& scene) : scene_(scene), thread_([this] { work(); }) {}

Load::~Load() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void Load::pause() {
  std::unique_lock lock(mutex_);
  paused_ = true;
  changed_.wait(lock, [this] { return !busy_; });
}

void Load::resume() {
  {
    const std::lock_guard lock(mutex_);
    paused_ = false;
  }
  changed_.notify_all();
}

bool Load::may_go() {
  std::unique_lock lock(mutex_);
  busy_ = false;
  changed_.notify_all();
  // Not faster than a job in a while, or there would be nothing but these.
  changed_.wait_for(lock, Milliseconds(300), [this] { return stop_; });
  changed_.wait(lock, [this] { return stop_ || !paused_; });
  busy_ = true;
  return !stop_;
}

void Load::work() {
  while (may_go()) step();
}

void Load::step() {
  const Api& api = ++steps_ % 2 == 0 ? scene_.stage.api() : scene_.stage.proxied();
  if (open_.name.empty()) open_ = scene_.catalogue.next(steps_ % 3 == 0 ? kMedium : kTiny, scene_.new_name());
  const std::string id = scene_.submit(api, open_, kLoadCall);
  if (id.empty()) return;
  open_ = {};
  v1::Job job;
  if (api.job(id, job, kLoadCall).ok()) scene_.ledger.saw(job);
}

}  // namespace affskel::chaos
