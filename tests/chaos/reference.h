#pragma once

#include "catalogue.h"

namespace affskel::chaos {

/// Lets a service without faults compute every recipe, and keeps the results as the references.  The
/// fields must equal those of `affskel-worker compute`, which knows no server.
/// @param dir for its files.
/// @throws std::runtime_error when they differ or do not come.
void make_references(const Programs& programs, const std::string& dir, Catalogue& catalogue);

}  // namespace affskel::chaos
