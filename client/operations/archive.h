#pragma once

#include <filesystem>
#include <vector>

#include "client/connection/session.h"

namespace affskel::client {

/// So many jobs go into one archive.
inline constexpr std::size_t kMaxArchived = 100;

/// Writes the main files of jobs (see main_files) with their meshes into a new .zip: of each job a folder that
/// is named after it.  Takes the room of the files, one after the other, beside that of the archive, and little
/// memory.
/// @param jobs finished ones. @param file must not exist.
/// @throws ClientError kLimit for more than kMaxArchived, and when the archive cannot be written; as fetch.
void write_archive(Session& session, const std::vector<v1::Job>& jobs, const std::filesystem::path& file);

}  // namespace affskel::client
