#pragma once

#include <gtest/gtest.h>

#include <string>

#include "database/errors.h"

namespace affskel::server {

/// Message of the StoreError that the call throws; "" when it throws none.
template <typename Call>
std::string error_of(Call call) {
  try {
    call();
  } catch (const StoreError& error) {
    return error.what();
  }
  return {};
}

}  // namespace affskel::server

/// Expects `statement` to throw a StoreError with the given code.
#define EXPECT_STORE_ERROR(statement, expected)                                               \
  try {                                                                                       \
    static_cast<void>(statement);                                                             \
    ADD_FAILURE() << "no error from " #statement;                                             \
  } catch (const ::affskel::server::StoreError& caught) {                                     \
    EXPECT_EQ(caught.code(), ::affskel::server::StoreError::Code::expected) << caught.what(); \
  }
