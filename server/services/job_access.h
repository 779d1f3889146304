#pragma once

#include <optional>
#include <string>

#include "access/identity.h"
#include "affskel/v1/client_service.pb.h"
#include "store/rows.h"

namespace affskel::server {

/// A job as this caller may name it: of jobs that it may not see none is found.
/// @throws StoreError kNotFound for a caller that may see no job at all.
JobRef job_ref(const std::string& text, const Identity& caller);

/// Whose jobs a list is of that asks for those of `asked` (empty = of all); empty = of all; nothing when
/// there is none of them that the caller may see.
std::optional<std::string> listed_owner(const std::string& asked, const Identity& caller);

/// Whose job it will be that this caller submits: its own; an admin may name another.
std::string owner_of_submission(const std::string& asked, const Identity& caller);

}  // namespace affskel::server
