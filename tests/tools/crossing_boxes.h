#pragma once

#include <string>

namespace affskel::tests {

/// OFF text of boxes of nearly the same size round one place, each of which crosses nearly all others.
/// Nothing but a look at every two of them tells which lies in which: making 20,000 of them, a file of 8 MB,
/// ready takes minutes.
std::string crossing_boxes(int count);

}  // namespace affskel::tests
