#pragma once

#include <set>
#include <string>

#include "store/rows.h"
#include "store/tx.h"

namespace affskel::server {

/// Takes what a worker gave to a job's field out of it, so that others compute it again, and gives the
/// worker no lease any more.  Goes are the values of all directions about which it told anything, and these
/// count as not done.  Where there was such a value, other workers, which knew it as a bound, were silent
/// about greater ones: then no direction counts as done.  A refinement begins anew: what it found at one point went on
/// to others.  What is left of the field is true, and only makes
/// the rest faster.
/// @param who the worker's id, a unique prefix of 6 characters or more, or its host: all its workers that
///   took part.
/// @throws StoreError kNotFound when no worker of that name told anything; kPrecondition when the job has no
///   field.
void distrust(Tx& tx, const JobRow& job, const std::string& who);

/// Whether it is to get no lease.
bool is_distrusted(Database& db, const std::string& worker);
/// All of them.
std::set<std::string> distrusted_workers(Database& db);

}  // namespace affskel::server
