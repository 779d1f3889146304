#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "database/sqlite.h"

namespace affskel::server {

/// Bytes that lie in pieces, a mesh or an artefact, and are not those that were stored.
struct PieceFault {
  std::int64_t artifact = 0;    ///< its row; 0 for a mesh
  std::int64_t erosion_id = 0;  ///< of an artefact
  std::string name;             ///< kind of an artefact, SHA-256 of a mesh
  std::string params_key;       ///< of an artefact
  std::string where;
  std::string what;
};

using OnPieceFault = std::function<void(const PieceFault&)>;

/// Checks sizes and SHA-256 of what is not marked for deletion.
void find_mesh_faults(Database& db, const OnPieceFault& on_fault);
void find_artifact_faults(Database& db, const OnPieceFault& on_fault);

}  // namespace affskel::server
