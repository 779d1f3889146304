#include "core/chord_level_edges.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>

#include "core/chord_edge.h"
#include "core/chord_squares.h"
#include "core/error.h"

namespace affskel::core {
namespace {

class LevelEdges {
 public:
  LevelEdges(const Lattice& lattice, const SolidParts& parts, const FrameField& field,
             std::vector<ChordShock>& shocks, const LevelEdgeOptions& options)
      : lattice_(lattice), parts_(parts), field_(field), shocks_(shocks), options_(options) {
    std::vector<std::uint32_t> sheet;
    for (std::uint32_t s = 0; s < shocks.size(); ++s) {
      if (shocks[s].turn >= options.least_turn) sheet.push_back(s);
    }
    rim_ = rim_squares(parts, shocks, sheet);
  }

  void add() {
    if (rim_.empty()) return;
    const std::vector<LatticeElement> edges = edges_of_rim();
    std::vector<ChordShock> found;
    for_each_edge(lattice_, [&](std::uint32_t x, std::uint32_t y, std::uint8_t axis, const auto& place) {
      if (field_.direction[x] == field_.direction[y]) return;
      const LatticeElement edge{{place[0], place[1], place[2]}, axis, parts_.of_point(x)};
      if (!std::binary_search(edges.begin(), edges.end(), edge)) return;
      if (const auto shock = on(edge, tangents_on_edge(field_, x, y, axis, place))) found.push_back(*shock);
    });
    put(found);
  }

 private:
  // Those of the rim's squares that are no shock of the sheet; ascending.
  std::vector<LatticeElement> edges_of_rim() const {
    std::vector<LatticeElement> edges;
    edges.reserve(3 * rim_.size());
    for (const auto& [square, s] : rim_) {
      const LatticeElement only = edge_of(shocks_[s], parts_);
      for (const LatticeElement& edge : edges_of(square)) {
        if (edge != only) edges.push_back(edge);
      }
    }
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    return edges;
  }

  // The only shock of a square on the rim.
  const ChordShock* only_shock(const LatticeElement& square) const {
    const auto found = std::lower_bound(rim_.begin(), rim_.end(), RimSquare{square, 0});
    return found != rim_.end() && found->first == square ? &shocks_[found->second] : nullptr;
  }

  std::optional<ChordShock> on(const LatticeElement& edge, ChordShock shock) const {
    if (!(shock.opening >= options_.least_opening)) return {};
    const auto squares = squares_round(edge);
    double turn = 0, strength = 0;
    for (std::size_t side : {0U, 2U}) {
      const ChordShock* a = only_shock(squares[side]);
      const ChordShock* b = only_shock(squares[side + 1]);
      if (a == nullptr || b == nullptr || std::min(a->turn, b->turn) <= turn) continue;
      turn = std::min(a->turn, b->turn);
      strength = std::min(a->strength, b->strength);
    }
    if (turn == 0) return {};
    if (!(shock.strength > 0)) shock.strength = 0;
    settle_on_edge(field_, shock);
    shock.turn = turn;
    shock.strength = std::max(shock.strength, strength);
    return shock;
  }

  // In the place of a weaker one on the same edge, if there is one.
  void put(const std::vector<ChordShock>& found) {
    const std::size_t old_end = shocks_.size();
    for (const ChordShock& shock : found) {
      const auto end = shocks_.begin() + static_cast<std::ptrdiff_t>(old_end);
      const auto same = std::lower_bound(shocks_.begin(), end, shock, by_edge);
      if (same != end && !by_edge(shock, *same)) {
        *same = shock;
      } else {
        shocks_.push_back(shock);
      }
    }
    std::sort(shocks_.begin() + static_cast<std::ptrdiff_t>(old_end), shocks_.end(), by_edge);
    std::inplace_merge(shocks_.begin(), shocks_.begin() + static_cast<std::ptrdiff_t>(old_end), shocks_.end(),
                       by_edge);
  }

  const Lattice& lattice_;
  const SolidParts& parts_;
  const FrameField& field_;
  std::vector<ChordShock>& shocks_;
  const LevelEdgeOptions& options_;
  std::vector<RimSquare> rim_;
};

}  // namespace

void add_level_edges(const Lattice& lattice, const SolidParts& parts, const FrameField& field,
                     std::vector<ChordShock>& shocks, const LevelEdgeOptions& options) {
  for (const double share : {options.least_turn, options.least_opening}) {
    if (!(share >= 0 && share <= 1)) {
      throw CoreError(CoreError::Code::kBadInput, "the least turn and opening must lie between 0 and 1");
    }
  }
  LevelEdges(lattice, parts, field, shocks, options).add();
}

}  // namespace affskel::core
