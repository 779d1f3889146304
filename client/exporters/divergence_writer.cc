#include "client/exporters/divergence_writer.h"

#include <cstring>

#include "client/error.h"
#include "client/exporters/numbers.h"

namespace affskel::client {

DivergenceWriter::DivergenceWriter(FileFormat format, AtomicFile& file, const LatticePoints& points)
    : file_(file), cursor_(points), separator_(format == FileFormat::kCsv ? ',' : ' ') {
  if (format == FileFormat::kCsv) file_.write("x,y,z,H\n");
}

void DivergenceWriter::data(std::string_view bytes) {
  while (!bytes.empty()) {
    const std::string_view piece = bytes.substr(0, sizeof(double) - rest_.size());
    rest_.append(piece);
    bytes.remove_prefix(piece.size());
    if (rest_.size() < sizeof(double)) return;
    double divergence = 0;
    std::memcpy(&divergence, rest_.data(), sizeof divergence);
    rest_.clear();
    value(divergence);
  }
}

void DivergenceWriter::value(double divergence) {
  if (cursor_.at_end())
    throw ClientError(ExitCode::kInternal, "the divergence has more values than sample points");
  const core::Vec3 place = cursor_.position();
  cursor_.advance();
  row_.clear();
  for (const double coordinate : {place.x, place.y, place.z}) {
    append_exact(row_, coordinate);
    row_.push_back(separator_);
  }
  append_exact(row_, divergence);
  row_.push_back('\n');
  file_.write(row_);
}

void DivergenceWriter::finish() {
  if (!rest_.empty() || !cursor_.at_end()) {
    throw ClientError(ExitCode::kInternal, "the divergence has fewer values than sample points");
  }
}

}  // namespace affskel::client
