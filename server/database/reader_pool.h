#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/mutex.h"
#include "database/sqlite.h"

namespace affskel::server {

/// Connections that read what is committed, so that short questions do not wait for a long write.
/// Thread-safe; a connection that met an error is not used again.
class ReaderPool {
 public:
  explicit ReaderPool(std::string file) : file_(std::move(file)) {}

  /// Runs body(Database&) in a read transaction of its own, and returns what it returns.
  template <typename Body>
  auto read(Body&& body) {
    Loan loan(*this);
    try {
      const Transaction transaction(*loan.db, Transaction::Kind::kRead);
      return body(*loan.db);
    } catch (const SqliteError&) {
      loan.db.reset();
      throw;
    }
  }

 private:
  struct Loan {
    explicit Loan(ReaderPool& from) : pool(from), db(from.take()) {}
    ~Loan() {
      if (db) pool.give_back(std::move(db));
    }
    Loan(const Loan&) = delete;
    Loan& operator=(const Loan&) = delete;
    ReaderPool& pool;
    std::unique_ptr<Database> db;
  };
  std::unique_ptr<Database> take();
  void give_back(std::unique_ptr<Database> db);

  const std::string file_;
  base::Mutex mutex_;
  std::vector<std::unique_ptr<Database>> idle_ ABSL_GUARDED_BY(mutex_);
};

}  // namespace affskel::server
