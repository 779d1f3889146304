#include "client/web/page_files.h"

#include <array>
#include <string_view>

#include "client/base/embedded_file.h"

AFFSKEL_EMBED(web_page, AFFSKEL_WEB_PAGE);
AFFSKEL_EMBED(web_style, AFFSKEL_WEB_STYLE);
AFFSKEL_EMBED(web_icon, AFFSKEL_WEB_ICON);
AFFSKEL_EMBED(web_script, AFFSKEL_WEB_SCRIPT);

namespace affskel::client {
namespace {

struct PageFile {
  std::string_view path, type, bytes;
};

const std::array<PageFile, 4>& page_files() {
  static const std::array<PageFile, 4> kFiles = {{
      {"/", "text/html; charset=utf-8", {affskel_web_page, affskel_web_page_end}},
      {"/page.js", "text/javascript; charset=utf-8", {affskel_web_script, affskel_web_script_end}},
      {"/page.css", "text/css; charset=utf-8", {affskel_web_style, affskel_web_style_end}},
      {"/icon.svg", "image/svg+xml", {affskel_web_icon, affskel_web_icon_end}},
  }};
  return kFiles;
}

// Its own files and nothing else; the interactive page of a job in a frame.
constexpr const char* kPolicy =
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self'; connect-src 'self'; "
    "frame-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'; "
    "require-trusted-types-for 'script'";

}  // namespace

http::Response send_page_file(WebCall& call) {
  http::Response response;
  for (const PageFile& file : page_files()) {
    if (file.path != call.request.path) continue;
    response.body = file.bytes;
    response.headers = {{"Content-Type", std::string(file.type)}};
  }
  if (call.request.path == "/") response.headers.emplace_back("Content-Security-Policy", kPolicy);
  return response;
}

}  // namespace affskel::client
