#pragma once

#include <gtest/gtest.h>

#include "store/errors.h"

/// Expects `statement` to throw a StoreError with the given code.
#define EXPECT_STORE_ERROR(statement, expected)                                               \
  try {                                                                                       \
    static_cast<void>(statement);                                                             \
    ADD_FAILURE() << "no error from " #statement;                                             \
  } catch (const ::affskel::server::StoreError& caught) {                                     \
    EXPECT_EQ(caught.code(), ::affskel::server::StoreError::Code::expected) << caught.what(); \
  }
