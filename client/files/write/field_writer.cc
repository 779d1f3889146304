#include "client/files/write/field_writer.h"

#include <cstring>

#include "client/base/error.h"
#include "client/files/numbers.h"
#include "wire/limits.h"

namespace affskel::client {
namespace {

class CsvWriter : public FieldWriter {
 public:
  explicit CsvWriter(AtomicFile& file) : file_(file) { file_.write("x,y,z,E,nx,ny,nz,direction\n"); }
  void put(const FieldPoint& p) override {
    row_.clear();
    for (const double value :
         {p.position.x, p.position.y, p.position.z, p.erosion, p.normal.x, p.normal.y, p.normal.z}) {
      append_exact(row_, value);
      row_.push_back(',');
    }
    append_integer(row_, p.direction);
    row_.push_back('\n');
    file_.write(row_);
  }
  void finish() override {}

 private:
  AtomicFile& file_;
  std::string row_;
};

// The published program's layout.
class DatWriter : public FieldWriter {
 public:
  explicit DatWriter(AtomicFile& file) : file_(file) {}
  void put(const FieldPoint& p) override {
    row_.clear();
    for (const double value :
         {p.position.x, p.position.y, p.position.z, p.erosion, p.normal.x, p.normal.y, p.normal.z}) {
      append_exact(row_, value);
      row_.push_back(' ');
    }
    row_.back() = '\n';
    file_.write(row_);
  }
  void finish() override {}

 private:
  AtomicFile& file_;
  std::string row_;
};

}  // namespace

std::unique_ptr<FieldWriter> make_field_writer(FileFormat format, AtomicFile& file,
                                               const LatticePoints& points) {
  switch (format) {
    case FileFormat::kCsv:
      return std::make_unique<CsvWriter>(file);
    case FileFormat::kDat:
      return std::make_unique<DatWriter>(file);
    case FileFormat::kVtkHdf:
      return make_vtkhdf_writer(file, points);
    default:
      break;
  }
  throw ClientError(ExitCode::kInternal, "no field writer for " + std::string(extension_of(format)));
}

void FieldDecoder::data(std::string_view bytes) {
  if (!rest_.empty()) {
    const std::size_t missing = std::min(wire::kFieldRecordBytes - rest_.size(), bytes.size());
    rest_.append(bytes.substr(0, missing));
    bytes.remove_prefix(missing);
    if (rest_.size() < wire::kFieldRecordBytes) return;
    record(rest_.data());
    rest_.clear();
  }
  for (; bytes.size() >= wire::kFieldRecordBytes; bytes.remove_prefix(wire::kFieldRecordBytes)) {
    record(bytes.data());
  }
  rest_.assign(bytes);
}

void FieldDecoder::record(const char* bytes) {
  if (cursor_.at_end())
    throw ClientError(ExitCode::kInternal, "the field has more records than sample points");
  // A record: double E, double area, uint32 direction.
  FieldPoint point;
  std::memcpy(&point.erosion, bytes, sizeof point.erosion);
  std::memcpy(&point.direction, bytes + 2 * sizeof(double), sizeof point.direction);
  const std::uint64_t first = 3 * std::uint64_t{point.direction};
  if (first + 3 > static_cast<std::uint64_t>(directions_.xyz_size())) {
    throw ClientError(ExitCode::kInternal, "the field names direction " + std::to_string(point.direction) +
                                               " of " + std::to_string(directions_.xyz_size() / 3));
  }
  const int at = static_cast<int>(first);
  point.normal = {directions_.xyz(at), directions_.xyz(at + 1), directions_.xyz(at + 2)};
  point.i = cursor_.i();
  point.j = cursor_.j();
  point.k = cursor_.k();
  point.position = cursor_.position();
  writer_.put(point);
  cursor_.advance();
}

void FieldDecoder::finish() {
  if (!rest_.empty() || !cursor_.at_end()) {
    throw ClientError(ExitCode::kInternal, "the field has fewer records than sample points");
  }
  writer_.finish();
}

}  // namespace affskel::client
