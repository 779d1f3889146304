#pragma once

#include <cstdint>

namespace affskel::tests {

// Of programs that have heap_bytes.cc among their sources, which replaces operator new.  The memory of the process tells less:
// how much of what was freed the C library keeps hangs on the length of the command line.

/// What is allocated by operator new and not freed, in bytes, and the most of it since the last call of begin_heap_peak().
std::uint64_t heap_bytes();
std::uint64_t heap_peak();

/// From here on the peak is looked for.
void begin_heap_peak();

}  // namespace affskel::tests
