#pragma once

#include <string>

namespace affskel::client {

/// A key that cannot be guessed: 256 bits from the kernel as 64 lower-case hexadecimal digits.
/// @throws ClientError kInternal when the kernel gives none.
std::string random_key();

}  // namespace affskel::client
