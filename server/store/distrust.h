#pragma once

#include <set>
#include <string>

#include "affskel/v1/worker_service.pb.h"
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
///   took part, and no worker there gets a lease until trust() says so, whatever becomes of the server.
/// @throws StoreError kNotFound when no worker of that name told anything; kPrecondition when the job has no
///   field.
void distrust(Tx& tx, const JobRow& job, const std::string& who);

/// Ids of workers, and hosts, that get no lease.
std::set<std::string> distrusted(Database& db);
/// @throws StoreError kForbidden where the worker is to get none.
void require_trusted(Database& db, const v1::WorkerIdentity& worker);

/// A host is no longer distrusted, nor is any worker there that was by itself.  What they gave to fields stays out of
/// them.
/// @throws StoreError kNotFound naming the hosts that are distrusted, or have such workers.
void trust(Database& db, const std::string& host);

}  // namespace affskel::server
