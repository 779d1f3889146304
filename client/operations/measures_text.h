#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "client/operations/measure.h"

namespace affskel::client {

/// Lines on the whole, then a table of the parts.
std::string measures_text(const Measures& measures);

/// The parts alone, with a header line; 17 significant digits.
std::string measures_csv(const Measures& measures);

nlohmann::ordered_json measures_json(const Measures& measures);

}  // namespace affskel::client
