#pragma once

namespace affskel::server {

/// Raises this process's limit on open files as far as it may: the usual 1024 is a heritage of select(),
/// which nothing here uses.  Children inherit it.
void raise_file_limit();

}  // namespace affskel::server
