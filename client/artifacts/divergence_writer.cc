#include "client/artifacts/divergence_writer.h"

#include "base/coding.h"

namespace affskel::client {

DivergenceWriter::DivergenceWriter(core::FileFormat format, base::AtomicFile& file,
                                   const LatticePoints& points, const core::FileFacts& facts)
    : table_(core::make_lattice_table(format, file, points.grid(), {{"H", {"H"}}}, facts)),
      values_(points, sizeof(double), "divergence", "values",
              [this](const SamplePoint& at, const char* bytes) {
                const double divergence = base::decode<double>(bytes);
                table_->put({at.i, at.j, at.k}, {&divergence, 1});
              }) {}

void DivergenceWriter::finish() {
  values_.finish();
  table_->finish();
}

}  // namespace affskel::client
