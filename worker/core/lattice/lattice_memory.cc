#include "core/lattice/lattice_memory.h"

#include <algorithm>

#include "base/number_text.h"

namespace affskel::core {
namespace {

// Kept: the places of a point in the orders of axes 0 and 1.
constexpr double kLatticeBytes = 8;
// On the way, for one axis at least: its points line by line, each with its place on the line.
constexpr double kBuildingBytes = 8;
// The crossings' bookkeeping: where a line's begin, twice while they are sorted into it.
constexpr double kLineBytes = 16;

// Left free by the spacing that is proposed: its digits are rounded, and the estimate is a lower one.
constexpr double kShareProposed = 0.85;

std::string bytes_text(double bytes) {
  return bytes < 1e9 ? base::rounded(bytes / 1e6, 2) + " MB" : base::rounded(bytes / 1e9, 2) + " GB";
}

LatticeSize coarser(const LatticeSize& size, double factor) {
  return {size.points / (factor * factor * factor), size.lines / (factor * factor), size.spacing * factor};
}

}  // namespace

double lattice_memory(const LatticeSize& size, double point_bytes) {
  return size.points * (kLatticeBytes + std::max(kBuildingBytes, point_bytes)) + size.lines * kLineBytes;
}

void require_lattice_memory(const LatticeSize& size, double point_bytes, std::uint64_t budget) {
  const double need = lattice_memory(size, point_bytes), available = static_cast<double>(budget);
  if (budget == 0 || need <= available) return;
  double factor = 1;
  while (lattice_memory(coarser(size, factor), point_bytes) > kShareProposed * available) factor *= 1.01;
  const LatticeSize fits = coarser(size, factor);
  const std::string points =
      size.points > 0
          ? base::rounded(size.points, 3) + " sample points at spacing " + base::rounded(size.spacing, 3)
          : base::rounded(size.lines, 3) + " lattice lines at spacing " + base::rounded(size.spacing, 3);
  throw LatticeMemoryError(
      points + " take about " + bytes_text(need) + " of memory, and this worker has " +
          bytes_text(available) + " available; spacing " + base::rounded(fits.spacing, 3) + " fits" +
          (fits.points >= 1 ? ", with about " + base::rounded(fits.points, 2) + " points" : ""),
      static_cast<std::uint64_t>(need));
}

}  // namespace affskel::core
