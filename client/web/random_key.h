#pragma once

#include <string>

namespace affskel::client {

/// A key that nobody can guess: 256 bits from the kernel as 64 lower-case hexadecimal digits.
/// @throws ClientError kInternal when the kernel gives none.
std::string random_key();

}  // namespace affskel::client
