#include "core/collapse/thinned_solid.h"

#include <algorithm>

namespace affskel::core {
namespace {

using Cell = DualComplex::Cell;

class SheetThinning {
 public:
  explicit SheetThinning(ThinnedSolid& solid) : solid_(solid) {}

  // Marks where the front has passed already.
  Collapsing::Due due(Cell cell, Cell coface, double now) {
    if (DualComplex::dimension(coface) == 3)
      return {std::max(now, static_cast<double>(solid_.depth[DualComplex::cube_of(coface)]))};
    solid_.fronts.stands_at(cell);
    const bool passed = solid_.fronts.is_passed(cell, coface);
    return {now + (passed ? 0 : 1), passed};
  }
  static bool stays(Cell cell) { return DualComplex::dimension(cell) == 0; }
  double level(Cell cell) const { return solid_.level(cell); }
  void wave_ends() { solid_.fronts.end_wave(); }
  void lost_coface(Cell cell, std::uint32_t, double now) {
    if (DualComplex::dimension(cell) == 0) solid_.note_freed(cell, now);
  }
  void removed(Cell cell, Cell coface, double, bool passed) {
    if (DualComplex::dimension(coface) == 2) solid_.cross(cell, coface, passed);
  }

 private:
  ThinnedSolid& solid_;
};

}  // namespace

void ThinnedSolid::cross(Cell edge, Cell square, bool passed) {
  const float when = fronts.cross(edge, square, passed);
  complex->for_each_face(edge, [&](Cell vertex) {
    float& here = bared[vertex];
    here = std::max(here, when);
  });
}

ThinnedSolid thinned_solid(const DualComplex& complex, std::span<const float> depth,
                           std::span<const double> height, ExecutionContext* context) {
  ThinnedSolid solid{.complex = &complex,
                     .depth = depth,
                     .height = height,
                     .cells = {},
                     .fronts = SheetFronts(complex, depth),
                     .bared = CellValues<float>(complex, DualComplex::places_of_dimension(0), 0),
                     .freed = CellValues<std::uint16_t>(complex, DualComplex::places_of_dimension(0), 0),
                     .slight = 1e-3 / *std::max_element(height.begin(), height.end())};
  Collapsing collapsing(complex, context);
  SheetThinning thinning(solid);
  collapsing.run(thinning);
  solid.cells = collapsing.cells();
  return solid;
}

}  // namespace affskel::core
