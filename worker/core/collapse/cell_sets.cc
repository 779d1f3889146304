#include "core/collapse/cell_sets.h"

namespace affskel::core {

bool is_bare(const DualComplex& complex, DualComplex::Cell cell, const CellSet& cells) {
  return !complex.any_coface(cell,
                             [&](DualComplex::Cell coface, std::uint32_t) { return cells.has(coface); });
}

void insert_closed(const DualComplex& complex, DualComplex::Cell cell, CellSet& set) {
  if (set.has(cell)) return;
  set.insert(cell);
  complex.for_each_face(cell, [&](DualComplex::Cell face) { insert_closed(complex, face, set); });
}

}  // namespace affskel::core
