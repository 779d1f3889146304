#include "check/piece_faults.h"

#include "wire/sha256.h"

namespace affskel::server {
namespace {

/// @param piece rows of index and bytes, by index.  @returns "" for sound ones.
std::string fault_of(Statement piece, std::int64_t bytes_recorded, const std::string& sha256) {
  wire::Sha256 hash;
  std::int64_t bytes = 0;
  for (std::int64_t index = 0; piece.step(); ++index) {
    if (piece.integer(0) != index) return "piece " + std::to_string(index) + " is missing";
    hash.update(piece.blob(1));
    bytes += static_cast<std::int64_t>(piece.blob(1).size());
  }
  if (bytes != bytes_recorded) {
    return "has " + std::to_string(bytes) + " bytes, recorded are " + std::to_string(bytes_recorded);
  }
  const std::string digest = hash.hex_digest();
  return digest == sha256 ? std::string() : "has the SHA-256 " + digest + ", recorded is " + sha256;
}

}  // namespace

void find_mesh_faults(Database& db, const OnPieceFault& on_fault) {
  Statement row =
      db.query("SELECT sha256, bytes FROM meshes WHERE sha256 NOT IN (SELECT sha256 FROM dropped_meshes)");
  while (row.step()) {
    PieceFault fault;
    fault.name = row.text(0);
    fault.where = "mesh " + fault.name;
    fault.what =
        fault_of(db.query("SELECT idx, data FROM mesh_chunks WHERE sha256 = ? ORDER BY idx", fault.name),
                 row.integer(1), fault.name);
    if (!fault.what.empty()) on_fault(fault);
  }
}

void find_artifact_faults(Database& db, const OnPieceFault& on_fault) {
  Statement row = db.query(
      "SELECT a.id, a.kind, a.erosion_id, a.bytes, a.sha256, a.params_key FROM artifacts a"
      " JOIN erosions e ON e.id = a.erosion_id WHERE e.dropped = 0");
  while (row.step()) {
    PieceFault fault;
    Columns columns(row);
    fault.artifact = columns.integer();
    fault.name = columns.text();
    fault.erosion_id = columns.integer();
    const std::int64_t bytes = columns.integer();
    const std::string sha256 = columns.text();
    fault.params_key = columns.text();
    fault.where = "artefact " + std::to_string(fault.artifact) + " (" + fault.name + " of erosion " +
                  std::to_string(fault.erosion_id) + ")";
    fault.what = fault_of(
        db.query("SELECT idx, data FROM artifact_chunks WHERE artifact_id = ? ORDER BY idx", fault.artifact),
        bytes, sha256);
    if (!fault.what.empty()) on_fault(fault);
  }
}

}  // namespace affskel::server
