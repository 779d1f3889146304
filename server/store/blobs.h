#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "database/sqlite.h"
#include "store/tx.h"

namespace affskel::server {

/// Stores a mesh unless its bytes are there already.  Requires `sha256` to be theirs.
void put_mesh(Tx& tx, const std::string& sha256, std::string_view bytes);

/// Whether a mesh is stored, and its bytes are not these.
bool mesh_is_damaged(const std::string& file, const std::string& sha256, std::string_view bytes);

/// Puts the right bytes in the place of damaged ones.
void heal_mesh(Tx& tx, const std::string& sha256, std::string_view bytes);

/// What an artefact is about.
struct ArtifactKey {
  std::int64_t erosion_id = 0;
  std::string kind;        ///< wire::ArtifactKindInfo::name
  std::string params_key;  ///< empty for lattice and directions
};

/// Stores an artefact; an equal key that is there already stays as it is.
/// @param items points, or vertices of a surface.
/// @param quality of a skeleton: serialized SkeletonQuality; empty for everything else.
void put_artifact(Tx& tx, const ArtifactKey& key, std::string_view bytes, std::int64_t items,
                  const std::string& quality = {});

/// Its row, if stored.
std::optional<std::int64_t> find_artifact(Database& db, const ArtifactKey& key);

/// Bytes of something stored, in pieces of at most 1 MiB.  Has its own connection: reading does not hold up
/// writers.  What never changes is read piece by piece, so that a slow reader does not keep the log long; a
/// field that still grows, from one consistent view.  Not thread-safe.
class BlobReader {
 public:
  virtual ~BlobReader() = default;
  std::uint64_t bytes() const { return bytes_; }
  const std::string& sha256() const { return sha256_; }
  /// The next piece; empty at the end.
  /// @throws StoreError kDamaged when what was read is not what was stored, at the latest at the end.
  virtual std::string next() = 0;

 protected:
  std::uint64_t bytes_ = 0;
  std::string sha256_;
};

/// @throws StoreError kNotFound when it is not (or no longer) there.
std::unique_ptr<BlobReader> read_mesh(const std::string& file, const std::string& sha256);
std::unique_ptr<BlobReader> read_artifact(const std::string& file, std::int64_t artifact_id);

/// The field as merged so far.
/// @throws StoreError kNotFound when the erosion is gone or was not prepared yet; kDamaged.
std::unique_ptr<BlobReader> read_field(const std::string& file, std::int64_t erosion_id);

/// The refined field as the rounds before the present one have left it, or when finished.
/// @throws StoreError kPrecondition in round 0; otherwise as read_field().
std::unique_ptr<BlobReader> read_refined(const std::string& file, std::int64_t erosion_id);

/// What the rounds after `known` and before the present one have found, see FetchInputRequest; everything, when some of
/// it is no longer told apart.
/// @throws as read_refined().
std::unique_ptr<BlobReader> read_refined_changes(const std::string& file, std::int64_t erosion_id,
                                                 std::int64_t known);

}  // namespace affskel::server
