#include "client/view/resources.h"

// The assembler copies the files: as string literals they would cost the compiler seconds.
#define AFFSKEL_EMBED(symbol, file)                       \
  __asm__(                                                \
      ".pushsection .rodata\n"                            \
      ".global affskel_" #symbol "\naffskel_" #symbol     \
      ":\n"                                               \
      ".incbin \"" file                                   \
      "\"\n"                                              \
      ".global affskel_" #symbol "_end\naffskel_" #symbol \
      "_end:\n"                                           \
      ".byte 0\n"                                         \
      ".popsection\n");                                   \
  extern "C" const char affskel_##symbol[];               \
  extern "C" const char affskel_##symbol##_end[]

AFFSKEL_EMBED(page_template, AFFSKEL_PAGE_TEMPLATE);
AFFSKEL_EMBED(page_style, AFFSKEL_PAGE_STYLE);
AFFSKEL_EMBED(page_overlay_style, AFFSKEL_PAGE_OVERLAY_STYLE);
AFFSKEL_EMBED(page_script, AFFSKEL_PAGE_SCRIPT);

namespace affskel::client {

std::string_view page_template() {
  return {affskel_page_template, affskel_page_template_end};
}

std::string_view page_style() {
  return {affskel_page_style, affskel_page_style_end};
}

std::string_view page_overlay_style() {
  return {affskel_page_overlay_style, affskel_page_overlay_style_end};
}

std::string_view page_script() {
  return {affskel_page_script, affskel_page_script_end};
}

}  // namespace affskel::client
