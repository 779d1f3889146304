#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>

#include "expect_store_error.h"
#include "small_disk.h"
#include "store_fixture.h"

namespace affskel::server {

constexpr std::uint64_t kMiB = std::uint64_t{1} << 20;

/// A store on a disk of its own.
class FullDiskTest : public StoreTest {
 protected:
  FullDiskTest() {
    store_.reset();
    std::filesystem::remove_all(directory_.path());
    std::filesystem::create_directory(directory_.path());
    options_.reserve_bytes = kMiB;
    options_.free_bytes = [this](const std::string&) { return disk_.free(); };
    open();
  }
  ~FullDiskTest() override { store_.reset(); }

  void tidy_up() {
    while (store_->tidy()) {
    }
  }

  std::uint64_t bytes_of(const std::string& name) const {
    const auto file = directory_.path() / name;
    return std::filesystem::exists(file) ? std::filesystem::file_size(file) : 0;
  }

  void finish_blocks() {
    for (;;) {
      const v1::Lease task = lease();
      if (task.kind() != v1::TASK_KIND_ERODE) return static_cast<void>(store_->give_back(task.token()));
      finish_block(task);
    }
  }

  /// Reports one direction after another until there is no room; returns how many were acknowledged.
  std::uint64_t report_until_full(const v1::Lease& lease, std::uint64_t from) {
    for (std::uint64_t position = from;; ++position) {
      if (position == lease.positions(0).end()) throw std::logic_error("the disk did not get full");
      try {
        report(lease, position, position + 1);
      } catch (const SqliteError& error) {
        EXPECT_EQ(error.primary_code(), SQLITE_FULL);
        return position;
      }
    }
  }

  SmallDisk disk_{directory_.path().string()};
};

}  // namespace affskel::server
