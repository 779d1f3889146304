#include "services/job_access.h"

#include "access/rules.h"
#include "base/quoted.h"
#include "database/errors.h"

namespace affskel::server {

JobRef job_ref(const std::string& text, const Identity& caller) {
  switch (jobs_of(caller.role)) {
    case Jobs::kAll:
      return {text, caller.owner, false};
    case Jobs::kOwn:
      return {text, caller.owner, true};
    case Jobs::kNone:
      break;
  }
  throw StoreError(StoreError::Code::kNotFound, "no job " + base::quoted(text));
}

std::optional<std::string> listed_owner(const std::string& asked, const Identity& caller) {
  const Jobs jobs = jobs_of(caller.role);
  if (jobs == Jobs::kAll) return asked;
  if (jobs == Jobs::kNone || (!asked.empty() && asked != caller.owner)) return std::nullopt;
  return caller.owner;
}

std::string owner_of_submission(const std::string& asked, const Identity& caller) {
  return caller.role == v1::ROLE_ADMIN && !asked.empty() ? asked : caller.owner;
}

}  // namespace affskel::server
