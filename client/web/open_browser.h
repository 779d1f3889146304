#pragma once

#include <filesystem>
#include <string>

#include "client/connection/environment.h"

namespace affskel::client {

/// Opens an address in the user's browser (xdg-open), when there is a display.  The address may hold a key,
/// and command lines are seen by all users: so the browser is given a file that leads there.
/// @param file does not exist yet, and no other user can enter its folder.
/// @return whether xdg-open was started and did not fail at once.
bool open_browser(const std::string& address, const std::filesystem::path& file,
                  const Environment& environment);

}  // namespace affskel::client
