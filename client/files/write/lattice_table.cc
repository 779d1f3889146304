#include "client/files/write/lattice_table.h"

#include <cstdint>

#include "client/base/error.h"
#include "client/files/numbers.h"
#include "client/files/write/vtkhdf_image.h"

namespace affskel::client {

class LatticeTable::Output {
 public:
  virtual ~Output() = default;
  virtual void put(const SamplePoint& at, std::span<const double> values) = 0;
  virtual void finish() = 0;
};

namespace {

class TextOutput : public LatticeTable::Output {
 public:
  TextOutput(base::AtomicFile& file, char separator, bool indices, const std::vector<LatticeColumn>& columns)
      : file_(file), separator_(separator) {
    for (const LatticeColumn& column : columns) {
      shown_.insert(shown_.end(), column.components.size(), indices || !column.whole);
    }
  }

  void write_header(const std::vector<LatticeColumn>& columns) {
    std::string header = "x,y,z";
    for (const LatticeColumn& column : columns) {
      for (const std::string& component : column.components) header += "," + component;
    }
    file_.write(header + "\n");
  }

  void put(const SamplePoint& at, std::span<const double> values) override {
    row_.clear();
    for (const double coordinate : {at.position.x, at.position.y, at.position.z}) append(coordinate);
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (shown_[i]) append(values[i]);
    }
    row_.back() = '\n';
    file_.write(row_);
  }

  void finish() override {}

 private:
  void append(double value) {
    append_exact(row_, value);
    row_.push_back(separator_);
  }

  base::AtomicFile& file_;
  char separator_;
  std::vector<bool> shown_;  // per value of a row
  std::string row_;
};

class ImageOutput : public LatticeTable::Output {
 public:
  ImageOutput(base::AtomicFile& file, const LatticePoints& points, const std::vector<LatticeColumn>& columns)
      : image_(file, points) {
    for (const LatticeColumn& column : columns) {
      const auto components = static_cast<unsigned>(column.components.size());
      Array array{components, nullptr, nullptr};
      if (column.whole) {
        array.whole = &image_.add(column.name.c_str(), components, static_cast<std::int32_t>(column.outside));
      } else {
        array.real = &image_.add(column.name.c_str(), components, column.outside);
      }
      arrays_.push_back(array);
    }
    inside_ = &image_.add("inside", 1, std::uint8_t{0});
  }

  void put(const SamplePoint& at, std::span<const double> values) override {
    image_.enter(at.i);
    auto value = values.begin();
    for (const Array& array : arrays_) {
      for (unsigned c = 0; c < array.components; ++c, ++value) {
        if (array.whole != nullptr) {
          array.whole->at(at.i, at.j, at.k, c) = static_cast<std::int32_t>(*value);
        } else {
          array.real->at(at.i, at.j, at.k, c) = *value;
        }
      }
    }
    inside_->at(at.i, at.j, at.k) = 1;
  }

  void finish() override { image_.finish(); }

 private:
  // Only one of the two arrays is used, by the type of the column.
  struct Array {
    unsigned components;
    VtkHdfArray<double>* real;
    VtkHdfArray<std::int32_t>* whole;
  };

  VtkHdfImage image_;
  std::vector<Array> arrays_;
  VtkHdfArray<std::uint8_t>* inside_ = nullptr;
};

std::unique_ptr<LatticeTable::Output> make_output(FileFormat format, base::AtomicFile& file,
                                                  const LatticePoints& points,
                                                  const std::vector<LatticeColumn>& columns) {
  switch (format) {
    case FileFormat::kCsv: {
      auto output = std::make_unique<TextOutput>(file, ',', true, columns);
      output->write_header(columns);
      return output;
    }
    case FileFormat::kDat:
      return std::make_unique<TextOutput>(file, ' ', false, columns);
    case FileFormat::kVtkHdf:
      return std::make_unique<ImageOutput>(file, points, columns);
    default:
      break;
  }
  throw ClientError(ExitCode::kInternal,
                    "no writer of sample points for " + std::string(extension_of(format)));
}

}  // namespace

LatticeTable::LatticeTable(FileFormat format, base::AtomicFile& file, const LatticePoints& points,
                           const std::vector<LatticeColumn>& columns)
    : output_(make_output(format, file, points, columns)) {}

LatticeTable::~LatticeTable() = default;

void LatticeTable::put(const SamplePoint& at, std::span<const double> values) {
  output_->put(at, values);
}

void LatticeTable::finish() {
  output_->finish();
}

}  // namespace affskel::client
