#pragma once

#include "client/web/web_state.h"

namespace affskel::client {

/// Sends the page, its script, its style or its icon, by the request's path.  They are the same for
/// all users.
http::Response send_page_file(WebCall& call);

}  // namespace affskel::client
