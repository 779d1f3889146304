#include "store/blobs.h"

#include <utility>

#include "base/logfmt.h"
#include "database/errors.h"
#include "store/field.h"
#include "wire/field_record.h"
#include "wire/limits.h"
#include "wire/sha256.h"

namespace affskel::server {
namespace {

/// Calls put(index, piece) for the pieces of `bytes`.
template <typename Put>
void cut(std::string_view bytes, Put put) {
  for (std::size_t index = 0; index * wire::kChunkBytes < bytes.size(); ++index) {
    put(index, bytes.substr(index * wire::kChunkBytes, wire::kChunkBytes));
  }
}

StoreError gone() {
  return {StoreError::Code::kNotFound, "what was asked for has been deleted"};
}

/// Whether the mesh or artefact is there, with its size and hash, and the statement for one piece of it.
struct Stored {
  const char* about;
  const char* piece;
  const char* name;
  const char* remedy;
};

constexpr Stored kMesh = {
    "SELECT bytes, sha256 FROM meshes WHERE sha256 = ? AND sha256 NOT IN (SELECT sha256 FROM dropped_meshes)",
    "SELECT data FROM mesh_chunks WHERE sha256 = ? AND idx = ?", "mesh",
    "submit the same file again, which mends it, and resume what failed"};

constexpr Stored kArtifact = {
    "SELECT bytes, sha256 FROM artifacts WHERE id = ?"
    " AND (SELECT dropped FROM erosions WHERE id = erosion_id) = 0",
    "SELECT data FROM artifact_chunks WHERE artifact_id = ? AND idx = ?", "artefact",
    "stop the server and run affskel-server check --repair, which has it made again"};

/// Pieces that lie in a table by index.
template <typename Key>
class ChunkReader final : public BlobReader {
 public:
  ChunkReader(const std::string& file, const Stored& stored, Key key)
      : db_(file, Database::Mode::kReadOnly), stored_(stored), key_(std::move(key)) {
    Statement row = db_.query(stored_.about, key_);
    if (!row.step()) throw gone();
    bytes_ = static_cast<std::uint64_t>(row.integer(0));
    sha256_ = row.text(1);
  }

  std::string next() override {
    std::string piece = load();
    read_ += piece.size();
    if (piece.empty() ? read_ != bytes_ : read_ > bytes_) fail();
    if (piece.empty()) return piece;
    hash_.update(piece);
    if (read_ == bytes_ && hash_.hex_digest() != sha256_) fail();
    return piece;
  }

 private:
  std::string load() {
    if (read_ == bytes_) return {};
    Statement row = db_.query(stored_.piece, key_, index_++);
    return row.step() ? std::string(row.blob(0)) : std::string();
  }

  [[noreturn]] void fail() {
    // Deleted meanwhile, it is not damaged.
    if (!db_.query(stored_.about, key_).step()) throw gone();
    throw StoreError(StoreError::Code::kDamaged, std::string("the stored ") + stored_.name + " (SHA-256 " +
                                                     sha256_ + ") is damaged: " + stored_.remedy);
  }

  Database db_;
  const Stored& stored_;
  Key key_;
  wire::Sha256 hash_;
  std::uint64_t read_ = 0;
  std::int64_t index_ = 0;
};

class FieldReader final : public BlobReader {
 public:
  FieldReader(const std::string& file, std::int64_t erosion_id)
      : db_(file, Database::Mode::kReadOnly), erosion_id_(erosion_id) {
    view_.emplace(db_, Transaction::Kind::kRead);
    if (!shape()) throw gone();
    field_.emplace(db_, erosion_id, points_);
    bytes_ = static_cast<std::uint64_t>(points_) * wire::kFieldRecordBytes;
    // The header of a transfer carries the hash, so the field is read twice.
    wire::Sha256 hash;
    for (std::int64_t i = 0; i < field_->chunk_count(); ++i) hash.update(field_->chunk(i));
    sha256_ = hash.hex_digest();
    if (finished_) view_.reset();
  }

  std::string next() override {
    if (index_ >= field_->chunk_count()) return {};
    if (finished_ && !(shape() && finished_)) throw gone();
    // Several chunks to a message, and not as many as it takes: each of many clients may let one wait.
    std::string bytes;
    while (index_ < field_->chunk_count() &&
           bytes.size() + kChunkPoints * wire::kFieldRecordBytes <= wire::kChunkBytes / 4) {
      bytes += field_->chunk(index_++);
    }
    return bytes;
  }

 private:
  /// False when it is gone.
  bool shape() {
    Statement row = db_.query(
        "SELECT points, finished FROM erosions WHERE id = ? AND dropped = 0"
        " AND points IS NOT NULL",
        erosion_id_);
    if (!row.step()) return false;
    points_ = row.integer(0);
    finished_ = row.flag(1);
    return true;
  }

  Database db_;
  std::int64_t erosion_id_;
  std::int64_t points_ = 0;
  bool finished_ = false;
  std::optional<Transaction> view_;  // of a field that still grows
  std::optional<FieldView> field_;
  std::int64_t index_ = 0;
};

void put_mesh_chunks(Tx& tx, const std::string& sha256, std::string_view bytes) {
  cut(bytes, [&](std::size_t index, std::string_view piece) {
    tx.db.run("INSERT INTO mesh_chunks (sha256, idx, data) VALUES (?, ?, ?)", sha256, index, Blob{piece});
  });
}

}  // namespace

void put_mesh(Tx& tx, const std::string& sha256, std::string_view bytes) {
  // Some of a dropped mesh may be gone already.
  tx.db.run("DELETE FROM meshes WHERE sha256 IN (SELECT sha256 FROM dropped_meshes WHERE sha256 = ?)",
            sha256);
  if (tx.db.integer("SELECT 1 FROM meshes WHERE sha256 = ?", sha256)) return;
  tx.db.run("INSERT INTO meshes (sha256, bytes, created_ms) VALUES (?, ?, ?)", sha256, bytes.size(),
            tx.wall_ms);
  put_mesh_chunks(tx, sha256, bytes);
}

bool mesh_is_damaged(const std::string& file, const std::string& sha256, std::string_view bytes) {
  try {
    const std::unique_ptr<BlobReader> reader = read_mesh(file, sha256);
    std::size_t at = 0;
    for (std::string piece = reader->next(); !piece.empty(); piece = reader->next()) {
      if (bytes.substr(at, piece.size()) != piece) return true;
      at += piece.size();
    }
    return at != bytes.size();
  } catch (const StoreError& error) {
    return error.code() == StoreError::Code::kDamaged;
  } catch (const SqliteError& error) {
    if (error.says_damaged()) return true;
    throw;
  }
}

void heal_mesh(Tx& tx, const std::string& sha256, std::string_view bytes) {
  // Dropped meanwhile, it is stored anew by the worker that needs it.
  if (!tx.db.integer("SELECT 1 FROM meshes WHERE sha256 = ?", sha256)) return;
  tx.require_room();
  tx.db.run("DELETE FROM mesh_chunks WHERE sha256 = ?", sha256);
  put_mesh_chunks(tx, sha256, bytes);
  tx.changes.log.push_back(base::logfmt("mesh_healed", {{"mesh", sha256}}));
}

void put_artifact(Tx& tx, const ArtifactKey& key, std::string_view bytes, std::int64_t items,
                  const std::string& quality) {
  if (find_artifact(tx.db, key)) return;
  tx.db.run(
      "INSERT INTO artifacts (erosion_id, kind, params_key, bytes, sha256, items) VALUES (?, ?, ?, ?, ?, ?)",
      key.erosion_id, key.kind, key.params_key, bytes.size(), wire::sha256_hex(bytes), items);
  const std::int64_t id = tx.db.last_insert_rowid();
  if (!quality.empty()) tx.db.run("UPDATE artifacts SET quality = ? WHERE id = ?", Blob{quality}, id);
  cut(bytes, [&](std::size_t index, std::string_view piece) {
    tx.db.run("INSERT INTO artifact_chunks (artifact_id, idx, data) VALUES (?, ?, ?)", id, index,
              Blob{piece});
  });
}

std::optional<std::int64_t> find_artifact(Database& db, const ArtifactKey& key) {
  return db.integer("SELECT id FROM artifacts WHERE erosion_id = ? AND kind = ? AND params_key = ?",
                    key.erosion_id, key.kind, key.params_key);
}

std::unique_ptr<BlobReader> read_mesh(const std::string& file, const std::string& sha256) {
  return std::make_unique<ChunkReader<std::string>>(file, kMesh, sha256);
}

std::unique_ptr<BlobReader> read_artifact(const std::string& file, std::int64_t artifact_id) {
  return std::make_unique<ChunkReader<std::int64_t>>(file, kArtifact, artifact_id);
}

std::unique_ptr<BlobReader> read_field(const std::string& file, std::int64_t erosion_id) {
  return std::make_unique<FieldReader>(file, erosion_id);
}

}  // namespace affskel::server
