#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "core/base/error.h"
#include "core/solid/solid.h"

namespace affskel::core {

/// Whether it has a note of this code.
inline bool has_note(const Solid& solid, const std::string& code) {
  return std::any_of(solid.notes.begin(), solid.notes.end(),
                     [&](const MeshNote& n) { return n.code == code; });
}

/// Why make_solid refuses the mesh; "" where it does not.
inline std::string refusal(const Mesh& mesh, bool repair = true) {
  try {
    SolidOptions options;
    options.repair = repair;
    make_solid(mesh, options);
    return "";
  } catch (const CoreError& error) {
    EXPECT_EQ(error.code(), CoreError::Code::kBadInput);
    return error.what();
  }
}

}  // namespace affskel::core
