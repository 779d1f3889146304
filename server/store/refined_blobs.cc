// The refined field as it is sent, see blobs.h.

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "database/errors.h"
#include "store/blobs.h"
#include "store/field.h"
#include "store/refined.h"
#include "wire/limits.h"
#include "wire/sha256.h"

namespace affskel::server {
namespace {

// As much at once as of a field: several chunks to a message.
constexpr std::size_t kPieceBytes = wire::kChunkBytes / 4;

struct Shape {
  std::int64_t points = 0;
  std::int64_t through = 0;  // the last round that is complete
  bool finished = false;
};

Shape shape_of(Database& db, std::int64_t erosion_id) {
  Statement row = db.query(
      "SELECT points, ifnull(round, 0), finished FROM erosions WHERE id = ? AND dropped = 0 AND points IS NOT NULL",
      erosion_id);
  if (!row.step()) throw StoreError(StoreError::Code::kNotFound, "what was asked for has been deleted");
  const Shape shape{row.integer(0), row.flag(2) ? row.integer(1) : row.integer(1) - 1, row.flag(2)};
  if (shape.through < 0) {
    throw StoreError(StoreError::Code::kPrecondition, "no round of the refinement is complete yet");
  }
  return shape;
}

/// Sends pieces from one consistent view; of a finished field without, so that a slow reader does not keep the log long.
/// The header of a transfer carries the hash, so that all is read twice.
class RefinedReader : public BlobReader {
 public:
  std::string next() final {
    if (!view_ && !shape_of(db_, erosion_id_).finished)
      throw StoreError(StoreError::Code::kNotFound, "the field is computed again");
    std::string bytes;
    while (bytes.size() < kPieceBytes) {
      if (at_ == piece_.size()) {
        if (index_ == count()) break;
        piece_ = piece(index_++);
        at_ = 0;
      }
      const std::size_t taken = std::min(piece_.size() - at_, kPieceBytes - bytes.size());
      bytes.append(piece_, at_, taken);
      at_ += taken;
    }
    return bytes;
  }

 protected:
  RefinedReader(const std::string& file, std::int64_t erosion_id)
      : db_(file, Database::Mode::kReadOnly),
        erosion_id_(erosion_id),
        view_(std::in_place, db_, Transaction::Kind::kRead),
        shape_(shape_of(db_, erosion_id)) {}

  virtual std::size_t count() const = 0;
  virtual std::string piece(std::size_t index) = 0;

  void sum_up() {
    wire::Sha256 hash;
    for (std::size_t index = 0; index < count(); ++index) {
      const std::string bytes = piece(index);
      hash.update(bytes);
      bytes_ += bytes.size();
    }
    sha256_ = hash.hex_digest();
    if (shape_.finished) view_.reset();
  }

  Database db_;
  const std::int64_t erosion_id_;
  std::optional<Transaction> view_;
  const Shape shape_;

 private:
  std::string piece_;
  std::size_t at_ = 0, index_ = 0;
};

class WholeReader final : public RefinedReader {
 public:
  /// @param named whether each record is preceded by its point.
  WholeReader(const std::string& file, std::int64_t erosion_id, bool named)
      : RefinedReader(file, erosion_id),
        named_(named),
        field_(db_, erosion_id, shape_.points, shape_.through) {
    sum_up();
  }

 private:
  std::size_t count() const override { return static_cast<std::size_t>(field_.chunk_count()); }

  std::string piece(std::size_t index) override {
    const std::string chunk = field_.chunk(static_cast<std::int64_t>(index));
    if (!named_) return chunk;
    const std::size_t points = chunk.size() / wire::kRefinedRecordBytes;
    std::string records(points * wire::kRefinedPointRecordBytes, '\0');
    for (std::size_t i = 0; i < points; ++i) {
      const auto point = static_cast<std::uint32_t>(index * static_cast<std::size_t>(kChunkPoints) + i);
      wire::encode_refined_point_record(
          records.data() + i * wire::kRefinedPointRecordBytes,
          {point, wire::decode_refined_record(chunk.data() + i * wire::kRefinedRecordBytes)});
    }
    return records;
  }

  const bool named_;
  const RefinedView field_;
};

class ChangesReader final : public RefinedReader {
 public:
  ChangesReader(const std::string& file, std::int64_t erosion_id, std::int64_t known)
      : RefinedReader(file, erosion_id) {
    // Every round that is not the last has found something.
    told_apart_ = known >= shape_.through || !refined_log_rows(db_, erosion_id, known, known + 1).empty();
    if (!told_apart_) return;
    rows_ = refined_log_rows(db_, erosion_id, known, shape_.through);
    sum_up();
  }

  bool told_apart() const { return told_apart_; }

 private:
  std::size_t count() const override { return rows_.size(); }
  std::string piece(std::size_t index) override { return load_refined_log(db_, erosion_id_, rows_[index]); }

  bool told_apart_ = false;
  std::vector<std::int64_t> rows_;  // of the log, for what they hold may be as large as the field
};

}  // namespace

std::unique_ptr<BlobReader> read_refined(const std::string& file, std::int64_t erosion_id) {
  return std::make_unique<WholeReader>(file, erosion_id, false);
}

std::unique_ptr<BlobReader> read_refined_changes(const std::string& file, std::int64_t erosion_id,
                                                 std::int64_t known) {
  auto changes = std::make_unique<ChangesReader>(file, erosion_id, known);
  if (changes->told_apart()) return changes;
  return std::make_unique<WholeReader>(file, erosion_id, true);
}

}  // namespace affskel::server
