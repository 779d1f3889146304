#pragma once

#include "client/base/notice.h"
#include "client/cli/console.h"

namespace affskel::client {

/// Prints a notice as a note or a warning: the file, the message, and the options to try.
void say(Console& console, const Notice& notice);
void say(Console& console, const Notices& notices);

}  // namespace affskel::client
