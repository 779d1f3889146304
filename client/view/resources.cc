#include "client/view/resources.h"

#include "client/base/embedded_file.h"

AFFSKEL_EMBED(page_template, AFFSKEL_PAGE_TEMPLATE);
AFFSKEL_EMBED(page_style, AFFSKEL_PAGE_STYLE);
AFFSKEL_EMBED(page_script, AFFSKEL_PAGE_SCRIPT);

namespace affskel::client {

std::string_view page_template() {
  return {affskel_page_template, affskel_page_template_end};
}

std::string_view page_style() {
  return {affskel_page_style, affskel_page_style_end};
}

std::string_view page_script() {
  return {affskel_page_script, affskel_page_script_end};
}

}  // namespace affskel::client
