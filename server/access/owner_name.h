#pragma once

#include <string>
#include <vector>

namespace affskel::server {

/// Refuses what is no good name of an owner: empty, over 100 bytes, no UTF-8, a blank at either end, a
/// character outside of ASCII that identifiers should not have, or scripts that no language mixes (Unicode
/// Technical Standard 39, sections 3.1 and 5.2: "highly restrictive").
/// @throws StoreError kInvalid, with the cause.
void check_owner_name(const std::string& owner);

/// The first of `others` that is not `owner`, but looks like it (UTS 39, section 4: their skeletons are
/// equal); empty when there is none.  @param owner, others UTF-8.
std::string look_alike(const std::string& owner, const std::vector<std::string>& others);

}  // namespace affskel::server
