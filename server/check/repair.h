#pragma once

#include <functional>
#include <string>

namespace affskel::server {

/// Hears what was repaired, a line each, after it was committed.
using RepairHandler = std::function<void(const std::string& action)>;

/// Repairs what a damaged disk has left of the database of a data directory, without which results could not
/// be served.  No server may run there: the caller holds the directory.
///
/// Indexes are built anew.  Of a damaged field the damaged rows are deleted and no direction counts as done
/// any more; what is sound of it stays, for it is true, and makes computing it again faster.  Damaged
/// artefacts are deleted and made again.  Jobs that were done, or had failed for the damage, are queued.  A
/// damaged mesh cannot be repaired; submitting the same file again does that.
/// @throws StoreError kUnusable for a database of another schema or none; SqliteError when the file itself is
///   too damaged, or the disk full.
void repair_database(const std::string& data_dir, const RepairHandler& on_action);

}  // namespace affskel::server
