#include "client/artifacts/divergence_writer.h"

#include <limits>

#include "base/coding.h"

namespace affskel::client {

DivergenceWriter::DivergenceWriter(FileFormat format, base::AtomicFile& file, const LatticePoints& points)
    : table_(format, file, points, {{"H", {"H"}, false, std::numeric_limits<double>::quiet_NaN()}}),
      values_(points, sizeof(double), "divergence", "values",
              [this](const SamplePoint& at, const char* bytes) {
                const double divergence = base::decode<double>(bytes);
                table_.put(at, {&divergence, 1});
              }) {}

void DivergenceWriter::finish() {
  values_.finish();
  table_.finish();
}

}  // namespace affskel::client
