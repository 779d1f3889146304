#include "calls/status.h"

#include <spdlog/spdlog.h>

#include <cstddef>
#include <iterator>
#include <new>
#include <string>

#include "base/logfmt.h"
#include "base/quoted.h"
#include "database/errors.h"
#include "database/sqlite.h"

namespace affskel::server {
namespace {

grpc::StatusCode code_of(StoreError::Code code) {
  switch (code) {
    case StoreError::Code::kInvalid:
      return grpc::StatusCode::INVALID_ARGUMENT;
    case StoreError::Code::kNotFound:
      return grpc::StatusCode::NOT_FOUND;
    case StoreError::Code::kExists:
      return grpc::StatusCode::ALREADY_EXISTS;
    case StoreError::Code::kPrecondition:
      return grpc::StatusCode::FAILED_PRECONDITION;
    case StoreError::Code::kFenced:
      return grpc::StatusCode::ABORTED;
    case StoreError::Code::kForbidden:
      return grpc::StatusCode::PERMISSION_DENIED;
    case StoreError::Code::kLimit:
      return grpc::StatusCode::RESOURCE_EXHAUSTED;
    case StoreError::Code::kUnusable:
      return grpc::StatusCode::INTERNAL;
    case StoreError::Code::kDamaged:
      return grpc::StatusCode::DATA_LOSS;
    case StoreError::Code::kLost:
      return grpc::StatusCode::UNAVAILABLE;
  }
  return grpc::StatusCode::INTERNAL;
}

grpc::StatusCode code_of(const SqliteError& error) {
  if (dynamic_cast<const OutOfFiles*>(&error) != nullptr) return grpc::StatusCode::UNAVAILABLE;
  if (error.says_damaged()) return grpc::StatusCode::DATA_LOSS;
  if (error.says_device()) return grpc::StatusCode::UNAVAILABLE;
  switch (error.primary_code()) {
    case SQLITE_FULL:
      return grpc::StatusCode::RESOURCE_EXHAUSTED;
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      return grpc::StatusCode::UNAVAILABLE;
    case SQLITE_TOOBIG:
    case SQLITE_NOMEM:
      return grpc::StatusCode::RESOURCE_EXHAUSTED;
    default:
      return grpc::StatusCode::INTERNAL;
  }
}

/// Statements and paths are for the log.
std::string told_of(const SqliteError& error) {
  if (dynamic_cast<const OutOfFiles*>(&error) != nullptr) {
    return "the server has as many files and connections open as it may; try again";
  }
  if (error.says_damaged()) {
    return "the server's disk cannot be read, or its database is damaged; its log says where, and"
           " affskel-server check --repair mends what can be mended";
  }
  if (error.says_device()) return "the server's disk cannot be written just now; its log says why, try again";
  switch (error.primary_code()) {
    case SQLITE_FULL:
      return error.what();
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      return "the server's database is busy; try again";
    case SQLITE_TOOBIG:
      return "this is more than the server's database can hold in one piece";
    case SQLITE_NOMEM:
      return "the server is out of memory";
    default:
      return "the server's database failed (SQLite code " + std::to_string(error.extended_code()) +
             "); its log says more";
  }
}

// gRPC drops an answer whose headers have more than 8 KiB, and the message is one of them, percent-encoded.
constexpr std::size_t kMaxMessageBytes = 1500;

void log_internal(const std::exception& error) {
  spdlog::error(base::logfmt("internal_error", {{"message", error.what()}}));
}

grpc::Status full_status_of(const std::exception_ptr& error) {
  try {
    std::rethrow_exception(error);
  } catch (const CallEnded& ended) {
    return ended.status;
  } catch (const StoreError& e) {
    if (e.code() == StoreError::Code::kUnusable) log_internal(e);
    if (e.code() == StoreError::Code::kDamaged)
      spdlog::error(base::logfmt("damaged", {{"message", e.what()}}));
    return {code_of(e.code()), e.what()};
  } catch (const SqliteError& e) {
    // The store logs a full disk once in a while; the calls that fail for it do not.
    if (e.primary_code() != SQLITE_FULL) log_error(e);
    return {code_of(e), told_of(e)};
  } catch (const std::bad_alloc&) {
    spdlog::error(base::logfmt("out_of_memory"));
    return {grpc::StatusCode::RESOURCE_EXHAUSTED, "the server is out of memory"};
  } catch (const std::exception& e) {
    log_internal(e);
    return {grpc::StatusCode::INTERNAL, e.what()};
  }
}

}  // namespace

void log_error(const SqliteError& error) {
  spdlog::error(base::logfmt("database_error", {{"code", error.extended_code()}, {"message", error.what()}}));
}

const char* code_name(grpc::StatusCode code) {
  static constexpr const char* kNames[] = {
      "OK",        "CANCELLED",      "UNKNOWN",           "INVALID_ARGUMENT",   "DEADLINE_EXCEEDED",
      "NOT_FOUND", "ALREADY_EXISTS", "PERMISSION_DENIED", "RESOURCE_EXHAUSTED", "FAILED_PRECONDITION",
      "ABORTED",   "OUT_OF_RANGE",   "UNIMPLEMENTED",     "INTERNAL",           "UNAVAILABLE",
      "DATA_LOSS", "UNAUTHENTICATED"};
  const auto number = static_cast<std::size_t>(code);
  return number < std::size(kNames) ? kNames[number] : "UNKNOWN";
}

grpc::Status status_of(const std::exception_ptr& error) {
  const grpc::Status status = full_status_of(error);
  return {status.error_code(), base::shortened(status.error_message(), kMaxMessageBytes)};
}

}  // namespace affskel::server
