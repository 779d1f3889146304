#pragma once

#include "database/sqlite.h"
#include "store/tx.h"

namespace affskel::server {

/// The error of a change that a full disk has no room for.
SqliteError full_disk(const Database& db);

/// Deletes a piece of what deleted jobs have left; false when nothing was left.
bool delete_piece(Tx& tx);

/// Shortens the database by some pages that nothing is in; false when there are none.  The file follows with
/// the next checkpoint.
bool give_pages_back(Database& db);

/// Rewrites a database that an older version made, if that is a matter of a second or two, so that its file
/// can shrink: SQLite settles this when it makes a file.  Larger ones stay as they are, and use again what is
/// freed in them.  @param free bytes free on the disk.
void let_pages_go(Database& db, std::uint64_t free);

}  // namespace affskel::server
