#include "client/base/lattice_points.h"

#include "client/base/error.h"

namespace affskel::client {
namespace {

[[noreturn]] void damaged(const char* what) {
  throw ClientError(ExitCode::kInternal, std::string("the server sent a damaged lattice: ") + what);
}

}  // namespace

LatticePoints::LatticePoints(const v1::Lattice& lattice) {
  if (lattice.origin_size() != 3 || lattice.axes_size() != 9 || lattice.dims_size() != 3) {
    damaged("wrong number of values");
  }
  if (lattice.run_start_size() != lattice.run_length_size()) damaged("runs without length");
  origin_ = {lattice.origin(0), lattice.origin(1), lattice.origin(2)};
  std::uint64_t cells = 1;
  for (int a = 0; a < 3; ++a) {
    axes_[static_cast<std::size_t>(a)] = {lattice.axes(3 * a), lattice.axes(3 * a + 1),
                                          lattice.axes(3 * a + 2)};
    dims_[static_cast<std::size_t>(a)] = lattice.dims(a);
    if (__builtin_mul_overflow(cells, std::uint64_t{lattice.dims(a)}, &cells)) damaged("too large");
  }
  runs_.reserve(static_cast<std::size_t>(lattice.run_start_size()));
  std::uint64_t next = 0;
  for (int r = 0; r < lattice.run_start_size(); ++r) {
    const Run run{lattice.run_start(r), lattice.run_length(r)};
    if (run.length == 0 || run.start < next || run.start >= cells || run.length > cells - run.start) {
      damaged("runs out of order");
    }
    if (run.start % dims_[2] + run.length > dims_[2]) damaged("a run leaves its line");
    next = run.start + run.length;
    count_ += run.length;
    runs_.push_back(run);
  }
}

void LatticeCursor::enter_run() {
  if (at_end()) return;
  const LatticePoints::Run& run = points_.runs()[run_];
  const auto& dims = points_.dims();
  const std::uint64_t line = run.start / dims[2];
  k_ = static_cast<std::uint32_t>(run.start % dims[2]);
  j_ = static_cast<std::uint32_t>(line % dims[1]);
  i_ = static_cast<std::uint32_t>(line / dims[1]);
  left_ = run.length;
}

void LatticeCursor::advance() {
  ++k_;
  if (--left_ > 0) return;
  ++run_;
  enter_run();
}

}  // namespace affskel::client
