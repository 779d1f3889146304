#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace affskel::base {

/// Bytes of the kernel's random generator, which cannot be guessed.
/// @throws std::runtime_error when there are none, with errno set.
void fill_with_random(std::span<unsigned char> bytes);

/// So many of them as lower-case hexadecimal digits, two to a byte.  @throws as fill_with_random.
std::string random_hex(std::size_t bytes);

}  // namespace affskel::base
