#pragma once

#include <string>

namespace affskel::client {

/// Installs handlers for SIGINT, SIGTERM and SIGHUP that remove unfinished temporary files
/// (base::guard_temporary_file), print the message set below and exit with 128 + signal, and ignores SIGXFSZ
/// and SIGPIPE, so that a file that grows beyond the process's limit is an error of its write (EFBIG) like a
/// full disk.  Call once, early.
void install_interrupt_handlers();

/// What a person who interrupts now should know, e.g. that the job goes on; empty = nothing.
void set_interrupt_message(const std::string& text);

}  // namespace affskel::client
