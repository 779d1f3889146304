#pragma once

#include <string_view>

namespace affskel::client {

/// Files of client/view/web, compiled in.
std::string_view page_template();  ///< page.html, with its {{marks}}
std::string_view page_style();     ///< style.css and what it imports
std::string_view page_script();    ///< main.js and what it imports, with three.js and its licence

}  // namespace affskel::client
