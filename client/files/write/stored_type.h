#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>

#include "base/coding.h"
#include "client/base/shape_file.h"
#include "core/files/numbers.h"

namespace affskel::client {

/// How a binary format stores a column.
enum class Stored { kInt32, kUint32, kDouble };

/// The type that holds all values of the column exactly: a whole one only for columns meant to be whole.
inline Stored stored_as(const PointColumn& column) {
  const auto all_within = [&](double low, double high) {
    return std::all_of(column.values.begin(), column.values.end(),
                       [&](double v) { return v >= low && v <= high && v == std::floor(v); });
  };
  if (!column.whole) return Stored::kDouble;
  if (all_within(std::numeric_limits<std::int32_t>::min(), std::numeric_limits<std::int32_t>::max())) {
    return Stored::kInt32;
  }
  return all_within(0, std::numeric_limits<std::uint32_t>::max()) ? Stored::kUint32 : Stored::kDouble;
}

inline std::size_t bytes_of(Stored stored) {
  return stored == Stored::kDouble ? sizeof(double) : sizeof(std::int32_t);
}

/// Appends a value of such a column, little-endian.
inline void append_stored(std::string& bytes, double value, Stored stored) {
  switch (stored) {
    case Stored::kInt32:
      return base::append(bytes, static_cast<std::int32_t>(value));
    case Stored::kUint32:
      return base::append(bytes, static_cast<std::uint32_t>(value));
    case Stored::kDouble:
      return base::append(bytes, value);
  }
}

}  // namespace affskel::client
