#include "client/files/write/divergence_writer.h"

#include <cstring>
#include <limits>

#include "client/base/error.h"
#include "client/files/numbers.h"
#include "client/files/write/vtkhdf_image.h"

namespace affskel::client {
namespace {

class TextOutput : public DivergenceOutput {
 public:
  TextOutput(AtomicFile& file, char separator) : file_(file), separator_(separator) {}

  void put(const LatticeCursor& at, double divergence) override {
    const core::Vec3 place = at.position();
    row_.clear();
    for (const double coordinate : {place.x, place.y, place.z}) {
      append_exact(row_, coordinate);
      row_.push_back(separator_);
    }
    append_exact(row_, divergence);
    row_.push_back('\n');
    file_.write(row_);
  }

  void finish() override {}

 private:
  AtomicFile& file_;
  char separator_;
  std::string row_;
};

class VtkHdfOutput : public DivergenceOutput {
 public:
  VtkHdfOutput(AtomicFile& file, const LatticePoints& points)
      : image_(file, points),
        divergence_(image_.add("H", 1, std::numeric_limits<double>::quiet_NaN())),
        inside_(image_.add("inside", 1, std::uint8_t{0})) {}

  void put(const LatticeCursor& at, double divergence) override {
    image_.enter(at.i());
    divergence_.at(at.i(), at.j(), at.k()) = divergence;
    inside_.at(at.i(), at.j(), at.k()) = 1;
  }

  void finish() override { image_.finish(); }

 private:
  VtkHdfImage image_;
  VtkHdfArray<double>& divergence_;
  VtkHdfArray<std::uint8_t>& inside_;
};

std::unique_ptr<DivergenceOutput> make_output(FileFormat format, AtomicFile& file,
                                              const LatticePoints& points) {
  if (format == FileFormat::kVtkHdf) return std::make_unique<VtkHdfOutput>(file, points);
  if (format == FileFormat::kDat) return std::make_unique<TextOutput>(file, ' ');
  file.write("x,y,z,H\n");
  return std::make_unique<TextOutput>(file, ',');
}

}  // namespace

DivergenceWriter::DivergenceWriter(FileFormat format, AtomicFile& file, const LatticePoints& points)
    : cursor_(points), output_(make_output(format, file, points)) {}

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
  output_->put(cursor_, divergence);
  cursor_.advance();
}

void DivergenceWriter::finish() {
  if (!rest_.empty() || !cursor_.at_end()) {
    throw ClientError(ExitCode::kInternal, "the divergence has fewer values than sample points");
  }
  output_->finish();
}

}  // namespace affskel::client
