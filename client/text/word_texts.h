#pragma once

#include <nlohmann/json.hpp>

namespace affskel::client {

/// What the protocol's words mean to people, for pages: "states", "stages", "operators", "frames" and "minima", each an
/// object of words and texts in the protocol's order.  A word without a text of its own stands for itself.
nlohmann::ordered_json word_texts();

}  // namespace affskel::client
