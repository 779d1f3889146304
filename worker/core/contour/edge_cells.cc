#include "core/contour/edge_cells.h"

#include <algorithm>
#include <string>

#include "core/base/error.h"

namespace affskel::core {
namespace {

// Steps from an edge's lower end to its four cells, along the two other axes, once round.
constexpr std::array<std::array<int, 2>, 4> kRing{{{-1, -1}, {0, -1}, {0, 0}, {-1, 0}}};

struct Entry {
  std::uint64_t cell;
  std::uint32_t part;
  std::uint32_t edge;
  std::uint32_t corner;  // of the ring
};

class CellSorter {
 public:
  CellSorter(const Lattice& lattice, const SolidParts& parts, std::span<const LatticeEdge> edges)
      : parts_(parts), edges_(edges) {
    for (std::size_t k = 0; k < 3; ++k) side_[k] = std::uint64_t{lattice.grid.dims[k]} + 1;
  }

  EdgeCells run() {
    list_entries();
    EdgeCells cells;
    cells.ring.resize(edges_.size());
    cells.members.reserve(entries_.size());
    for (std::size_t e = 0; e < entries_.size(); ++e) {
      const Entry& entry = entries_[e];
      if (e == 0 || entries_[e - 1].cell != entry.cell || entries_[e - 1].part != entry.part) {
        cells.place.push_back(place(entry.cell));
        cells.part.push_back(entry.part);
        cells.begin.push_back(static_cast<std::uint32_t>(e));
      }
      cells.ring[entry.edge][entry.corner] = static_cast<std::uint32_t>(cells.place.size() - 1);
      cells.members.push_back(entry.edge);
    }
    cells.begin.push_back(static_cast<std::uint32_t>(entries_.size()));
    return cells;
  }

 private:
  void list_entries() {
    entries_.reserve(4 * edges_.size());
    for (std::uint32_t s = 0; s < edges_.size(); ++s) {
      const std::uint32_t part = parts_.of_point(edges_[s].point);
      const std::size_t u = (edges_[s].axis + 1U) % 3, v = (edges_[s].axis + 2U) % 3;
      for (std::uint32_t corner = 0; corner < 4; ++corner) {
        CellPlace at{edges_[s].place[0], edges_[s].place[1], edges_[s].place[2]};
        at[u] += kRing[corner][0];
        at[v] += kRing[corner][1];
        entries_.push_back({key(at), part, s, corner});
      }
    }
    std::sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) {
      if (a.cell != b.cell) return a.cell < b.cell;
      return a.part != b.part ? a.part < b.part : a.edge < b.edge;
    });
  }

  std::uint64_t key(const CellPlace& at) const {
    return (static_cast<std::uint64_t>(at[0] + 1) * side_[1] + static_cast<std::uint64_t>(at[1] + 1)) *
               side_[2] +
           static_cast<std::uint64_t>(at[2] + 1);
  }

  CellPlace place(std::uint64_t key) const {
    const auto k = static_cast<std::int64_t>(key % side_[2]);
    const std::uint64_t row = key / side_[2];
    return {static_cast<std::int64_t>(row / side_[1]) - 1, static_cast<std::int64_t>(row % side_[1]) - 1,
            k - 1};
  }

  const SolidParts& parts_;
  std::span<const LatticeEdge> edges_;
  std::array<std::uint64_t, 3> side_{};
  std::vector<Entry> entries_;
};

}  // namespace

EdgeCells edge_cells(const Lattice& lattice, const SolidParts& parts, std::span<const LatticeEdge> edges) {
  constexpr std::size_t kMaxEdges = (std::size_t{1} << 30) - 1;  // four entries each, numbered in 32 bits
  if (edges.size() > kMaxEdges) {
    throw CoreError(CoreError::Code::kLimit, "too many crossings to join: " + std::to_string(edges.size()) +
                                                 "; take a larger spacing");
  }
  return CellSorter(lattice, parts, edges).run();
}

}  // namespace affskel::core
