#pragma once

#include <functional>

#include "check/field_faults.h"

namespace affskel::server {

/// Checks the stored rows of a field's refinement: their checksums, sizes and places, whether each value is one that a
/// report may have brought and not above the set's, and that none is missing.  Where something is at fault, the
/// refinement begins anew.
void find_refined_faults(Database& db, const FieldShape& field,
                         const std::function<void(FieldFault)>& on_fault);

}  // namespace affskel::server
