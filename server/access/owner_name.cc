#include "access/owner_name.h"

#include <unicode/uset.h>
#include <unicode/uspoof.h>
#include <unicode/utypes.h>

#include <memory>
#include <stdexcept>

#include "base/quoted.h"
#include "base/utf8.h"
#include "database/errors.h"

namespace affskel::server {
namespace {

constexpr std::size_t kMaxOwnerBytes = 100;

struct Close {
  void operator()(USpoofChecker* checker) const { uspoof_close(checker); }
  void operator()(USet* set) const { uset_close(set); }
};
using Checker = std::unique_ptr<USpoofChecker, Close>;

void require(UErrorCode status) {
  if (U_FAILURE(status)) throw std::runtime_error(std::string("Unicode tables: ") + u_errorName(status));
}

Checker make_checker() {
  UErrorCode status = U_ZERO_ERROR;
  Checker checker(uspoof_open(&status));
  require(status);
  const std::unique_ptr<USet, Close> allowed(uset_cloneAsThawed(uspoof_getRecommendedSet(&status)));
  uset_addRange(allowed.get(), ' ', '~');
  uspoof_setAllowedChars(checker.get(), allowed.get(), &status);
  uspoof_setRestrictionLevel(checker.get(), USPOOF_HIGHLY_RESTRICTIVE);
  uspoof_setChecks(checker.get(), USPOOF_CHAR_LIMIT | USPOOF_INVISIBLE | USPOOF_RESTRICTION_LEVEL, &status);
  require(status);
  return checker;
}

std::string skeleton(const USpoofChecker& checker, const std::string& text) {
  UErrorCode status = U_ZERO_ERROR;
  std::string result(16, '\0');
  for (;;) {
    const std::int32_t size =
        uspoof_getSkeletonUTF8(&checker, 0, text.data(), static_cast<std::int32_t>(text.size()),
                               result.data(), static_cast<std::int32_t>(result.size()), &status);
    const bool fits = status != U_BUFFER_OVERFLOW_ERROR;
    if (!fits) status = U_ZERO_ERROR;
    require(status);
    result.resize(static_cast<std::size_t>(size));
    if (fits) return result;
  }
}

/// What is wrong with a name; empty when nothing is.
std::string fault_of(const std::string& owner) {
  if (owner.empty() || owner.size() > kMaxOwnerBytes) return "expected 1 .. 100 bytes";
  if (!base::is_utf8(owner)) return "it is not UTF-8";
  if (owner.front() == ' ' || owner.back() == ' ') return "it has a blank at an end";
  UErrorCode status = U_ZERO_ERROR;
  const std::int32_t failed = uspoof_check2UTF8(make_checker().get(), owner.data(),
                                                static_cast<std::int32_t>(owner.size()), nullptr, &status);
  require(status);
  if ((failed & (USPOOF_CHAR_LIMIT | USPOOF_INVISIBLE)) != 0) {
    return "it has a character that nobody sees, or that is not for names";
  }
  return failed == 0 ? "" : "it mixes scripts whose letters look alike";
}

}  // namespace

void check_owner_name(const std::string& owner) {
  if (const std::string fault = fault_of(owner); !fault.empty()) {
    throw StoreError(StoreError::Code::kInvalid,
                     "the owner " + base::quoted(owner) + " is no good name: " + fault);
  }
}

std::string look_alike(const std::string& owner, const std::vector<std::string>& others) {
  const Checker checker = make_checker();
  const std::string own = skeleton(*checker, owner);
  for (const std::string& other : others) {
    if (other != owner && skeleton(*checker, other) == own) return other;
  }
  return "";
}

}  // namespace affskel::server
