#include "store/blobs.h"

#include "errors.h"
#include "store/field.h"
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

/// A read transaction of its own.
struct View {
  explicit View(const std::string& file)
      : db(file, Database::Mode::kReadOnly), transaction(db, Transaction::Kind::kRead) {}
  Database db;
  Transaction transaction;
};

/// Pieces that lie in a table by index.
class ChunkReader final : public BlobReader {
 public:
  ChunkReader(const std::string& file, const char* about, const char* piece, const auto& key)
      : view_(file), pieces_(open(about, piece, key)) {}

  std::string next() override {
    if (!pieces_.step()) return {};
    return std::string(pieces_.blob(0));
  }

 private:
  Statement open(const char* about, const char* piece, const auto& key) {
    Statement row = view_.db.query(about, key);
    if (!row.step()) throw gone();
    bytes_ = static_cast<std::uint64_t>(row.integer(0));
    sha256_ = row.text(1);
    return view_.db.query(piece, key);
  }

  View view_;
  Statement pieces_;
};

class FieldReader final : public BlobReader {
 public:
  FieldReader(const std::string& file, std::int64_t erosion_id) : view_(file) {
    const std::optional<std::int64_t> points =
        view_.db.integer("SELECT points FROM erosions WHERE id = ? AND dropped = 0", erosion_id);
    if (!points) throw gone();
    field_.emplace(view_.db, erosion_id, *points);
    bytes_ = static_cast<std::uint64_t>(*points) * wire::kFieldRecordBytes;
    // The header of a transfer carries the hash, so the field is read twice, from one view.
    wire::Sha256 hash;
    for (std::int64_t i = 0; i < field_->chunk_count(); ++i) hash.update(field_->chunk(i));
    sha256_ = hash.hex_digest();
  }

  std::string next() override {
    if (index_ >= field_->chunk_count()) return {};
    // Several chunks to a message, and not as many as it takes: each of many clients may let one wait.
    std::string bytes;
    while (index_ < field_->chunk_count() &&
           bytes.size() + kChunkPoints * wire::kFieldRecordBytes <= wire::kChunkBytes / 4) {
      bytes += field_->chunk(index_++);
    }
    return bytes;
  }

 private:
  View view_;
  std::optional<FieldView> field_;
  std::int64_t index_ = 0;
};

}  // namespace

void put_mesh(Tx& tx, const std::string& sha256, std::string_view bytes) {
  // Some of a dropped mesh may be gone already.
  tx.db.run("DELETE FROM meshes WHERE sha256 IN (SELECT sha256 FROM dropped_meshes WHERE sha256 = ?)",
            sha256);
  if (tx.db.integer("SELECT 1 FROM meshes WHERE sha256 = ?", sha256)) return;
  tx.db.run("INSERT INTO meshes (sha256, bytes, created_ms) VALUES (?, ?, ?)", sha256, bytes.size(),
            tx.wall_ms);
  cut(bytes, [&](std::size_t index, std::string_view piece) {
    tx.db.run("INSERT INTO mesh_chunks (sha256, idx, data) VALUES (?, ?, ?)", sha256, index, Blob{piece});
  });
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
  return std::make_unique<ChunkReader>(file,
                                       "SELECT bytes, sha256 FROM meshes WHERE sha256 = ?"
                                       " AND sha256 NOT IN (SELECT sha256 FROM dropped_meshes)",
                                       "SELECT data FROM mesh_chunks WHERE sha256 = ? ORDER BY idx", sha256);
}

std::unique_ptr<BlobReader> read_artifact(const std::string& file, std::int64_t artifact_id) {
  return std::make_unique<ChunkReader>(file,
                                       "SELECT bytes, sha256 FROM artifacts WHERE id = ?"
                                       " AND (SELECT dropped FROM erosions WHERE id = erosion_id) = 0",
                                       "SELECT data FROM artifact_chunks WHERE artifact_id = ? ORDER BY idx",
                                       artifact_id);
}

std::unique_ptr<BlobReader> read_field(const std::string& file, std::int64_t erosion_id) {
  return std::make_unique<FieldReader>(file, erosion_id);
}

}  // namespace affskel::server
