#pragma once

/// Puts a file into the program: affskel_SYMBOL points at its first byte, affskel_SYMBOL_end behind its last.
/// The assembler copies it: as a string literal it would cost the compiler seconds.
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
