// Step 3 of chord_pruning.h joins pieces by shortest paths from all pieces at once, then a least spanning
// tree of the pieces (Mehlhorn 1988).  A shock costs 1 / (r w): 1 for opposite normals, 4 at 60 degrees, 100
// and more between two facets.
//
// Step 4 fills a hole only where the rim shrinks: without that rule, a sheet that goes from one layer of
// cells to the next fills up with the facets in between.
//
// The significance of 0.005, at height / 190 on 11 bodies of 292 to 8560 triangles, leaves one component on
// all in the frame `axis` and on nine in `affine`; 0.02 leaves one on all in both.
#include "core/chords/chord_pruning.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>
#include <utility>

#include "core/base/disjoint_sets.h"
#include "core/base/require.h"
#include "core/chords/chord_edge.h"
#include "core/chords/chord_squares.h"
#include "core/contour/edge_cells.h"

namespace affskel::core {
namespace {

constexpr std::uint32_t kNone = 0xFFFFFFFFU;

double weight(const ChordShock& shock) {
  return squares_of(shock) * shock.strength * shock.turn;
}

double cost(const ChordShock& shock) {
  return 1 / (shock.strength * shock.turn);
}

// The cheapest path from every cell to a piece, and the paths between pieces that follow from them.  A piece
// is named by one of its shocks.
class Paths {
 public:
  struct Path {
    double cost;
    std::uint32_t shock, a, b;  // crosses from cell a through the shock to cell b
  };

  // piece: per cell, kNone where there is none.
  Paths(const std::vector<ChordShock>& shocks, const EdgeCells& cells, std::vector<std::uint32_t> piece)
      : shocks_(shocks),
        cells_(cells),
        piece_(std::move(piece)),
        through_(cells.size(), kNone),
        from_(cells.size(), kNone),
        distance_(cells.size(), std::numeric_limits<double>::infinity()) {
    spread();
  }

  std::uint32_t piece(std::uint32_t cell) const { return piece_[cell]; }

  // Between different pieces, cheapest first.
  std::vector<Path> list() const {
    std::vector<Path> paths;
    for (std::uint32_t s = 0; s < shocks_.size(); ++s) {
      for (std::uint32_t a : cells_.ring[s]) {
        for (std::uint32_t b : cells_.ring[s]) {
          if (a >= b || piece_[a] == kNone || piece_[b] == kNone || piece_[a] == piece_[b]) continue;
          paths.push_back({distance_[a] + cost(shocks_[s]) + distance_[b], s, a, b});
        }
      }
    }
    std::stable_sort(paths.begin(), paths.end(),
                     [](const Path& p, const Path& q) { return p.cost < q.cost; });
    return paths;
  }

  // All shocks on a path, from piece to piece.
  template <class Visit>
  void for_each_shock(const Path& path, Visit visit) const {
    visit(path.shock);
    for (std::uint32_t end : {path.a, path.b}) {
      for (std::uint32_t cell = end; through_[cell] != kNone; cell = from_[cell]) visit(through_[cell]);
    }
  }

 private:
  void spread() {
    using Item = std::pair<double, std::uint32_t>;
    std::priority_queue<Item, std::vector<Item>, std::greater<>> front;
    for (std::uint32_t cell = 0; cell < cells_.size(); ++cell) {
      if (piece_[cell] == kNone) continue;
      distance_[cell] = 0;
      front.push({0, cell});
    }
    while (!front.empty()) {
      const auto [distance, cell] = front.top();
      front.pop();
      if (distance > distance_[cell]) continue;
      for (std::uint32_t s : cells_.edges_of(cell)) {
        const double there = distance + cost(shocks_[s]);
        for (std::uint32_t next : cells_.ring[s]) {
          if (!(there < distance_[next])) continue;
          distance_[next] = there;
          through_[next] = s;
          from_[next] = cell;
          piece_[next] = piece_[cell];
          front.push({there, next});
        }
      }
    }
  }

  const std::vector<ChordShock>& shocks_;
  const EdgeCells& cells_;
  std::vector<std::uint32_t> piece_, through_, from_;
  std::vector<double> distance_;
};

class Pruning {
 public:
  Pruning(const Lattice& lattice, const SolidParts& parts, const std::vector<ChordShock>& shocks,
          const ChordPruningOptions& options)
      : parts_(parts),
        shocks_(shocks),
        options_(options),
        cells_(edge_cells(lattice, parts, lattice_edges(shocks))),
        pieces_(shocks.size()),
        owner_(shocks.size(), kNone) {
    const double cell = lattice.spacing * lattice.spacing * lattice.spacing;
    for (std::uint32_t p = 0; p < parts.count(); ++p) {
      min_erosion_.push_back(options.min_erosion * (parts.points(p) * cell));
    }
  }

  SignificantShocks run() {
    count();
    join_touching();
    keep_significant();
    join_kept();
    while (fill_holes()) {
    }
    for (std::uint32_t s = 0; s < shocks_.size(); ++s) {
      if (kept(s)) result_.shocks.push_back(shocks_[s]);
    }
    return std::move(result_);
  }

 private:
  std::uint32_t part(std::uint32_t s) const { return cells_.part[cells_.ring[s][0]]; }

  bool wide(std::uint32_t s) const { return shocks_[s].turn >= options_.strong_turn; }

  bool strong(std::uint32_t s) const { return wide(s) && shocks_[s].erosion >= min_erosion_[part(s)]; }

  void count() {
    ShockCensus& census = result_.census;
    census.candidates = shocks_.size();
    for (std::uint32_t s = 0; s < shocks_.size(); ++s) {
      census.wide += wide(s) ? 1 : 0;
      census.strong += strong(s) ? 1 : 0;
      census.max_turn = std::max(census.max_turn, shocks_[s].turn);
    }
  }

  void join_touching() {
    for (std::uint32_t cell = 0; cell < cells_.size(); ++cell) {
      std::uint32_t first = kNone;
      for (std::uint32_t s : cells_.edges_of(cell)) {
        if (!strong(s)) continue;
        if (first == kNone) first = s;
        pieces_.unite(first, s);
      }
    }
  }

  bool kept(std::uint32_t s) const { return owner_[s] != kNone; }

  // Per cell the piece of its shocks; piece_of gives a shock's piece or kNone.
  template <class PieceOf>
  std::vector<std::uint32_t> pieces_by_cell(PieceOf piece_of) {
    std::vector<std::uint32_t> piece(cells_.size(), kNone);
    for (std::uint32_t s = 0; s < shocks_.size(); ++s) {
      const std::uint32_t p = piece_of(s);
      if (p == kNone) continue;
      for (std::uint32_t cell : cells_.ring[s]) piece[cell] = p;
    }
    return piece;
  }

  void keep_significant() {
    const Paths paths(shocks_, cells_,
                      pieces_by_cell([&](std::uint32_t s) { return strong(s) ? pieces_.find(s) : kNone; }));
    std::vector<Paths::Path> used;
    for (const Paths::Path& path : paths.list()) {
      if (path.cost > options_.near_cost) break;
      if (pieces_.unite(paths.piece(path.a), paths.piece(path.b))) used.push_back(path);
    }
    std::vector<double> mass(shocks_.size(), 0), whole(min_erosion_.size(), 0);
    for (std::uint32_t s = 0; s < shocks_.size(); ++s) {
      if (!strong(s)) continue;
      mass[pieces_.find(s)] += weight(shocks_[s]);
      whole[part(s)] += weight(shocks_[s]);
    }
    const auto significant = [&](std::uint32_t s) {
      return mass[pieces_.find(s)] >= options_.significance * whole[part(s)];
    };
    for (std::uint32_t s = 0; s < shocks_.size(); ++s) {
      if (!strong(s)) continue;
      const double share = mass[s] / whole[part(s)];  // 0 unless s stands for its piece
      result_.census.max_piece_share = std::max(result_.census.max_piece_share, share);
      if (!significant(s)) continue;
      owner_[s] = pieces_.find(s);
      if (owner_[s] == s) result_.pieces.push_back(share);
    }
    std::sort(result_.pieces.begin(), result_.pieces.end(), std::greater<>());
    for (const Paths::Path& path : used) {
      if (significant(paths.piece(path.a))) keep_path(paths, path);
    }
  }

  void keep_path(const Paths& paths, const Paths::Path& path) {
    paths.for_each_shock(path, [&](std::uint32_t s) {
      if (!kept(s)) owner_[s] = pieces_.find(paths.piece(path.a));
    });
  }

  void join_kept() {
    const Paths paths(shocks_, cells_, pieces_by_cell([&](std::uint32_t s) { return owner_[s]; }));
    for (const Paths::Path& path : paths.list()) {
      if (!pieces_.unite(paths.piece(path.a), paths.piece(path.b))) continue;
      ++result_.bridges;
      keep_path(paths, path);
    }
  }

  // Adds all shocks at once, so that their order does not matter; returns whether there were any.
  bool fill_holes() {
    std::vector<std::uint8_t> used(cells_.size(), 0);
    std::vector<std::uint32_t> sheet;
    for (std::uint32_t s = 0; s < shocks_.size(); ++s) {
      if (!kept(s)) continue;
      sheet.push_back(s);
      for (std::uint32_t cell : cells_.ring[s]) used[cell] = 1;
    }
    const std::vector<RimSquare> rim = rim_squares(parts_, shocks_, sheet);
    bool any = false;
    for (std::uint32_t s = 0; s < shocks_.size(); ++s) {
      const auto& ring = cells_.ring[s];
      if (kept(s) || !std::all_of(ring.begin(), ring.end(), [&](std::uint32_t c) { return used[c] != 0; }))
        continue;
      if (rim_round(s, rim) < kMinRimSquares) continue;
      owner_[s] = s;
      any = true;
    }
    return any;
  }

  // How many of the squares round a shock's edge lie on the rim.
  std::size_t rim_round(std::uint32_t s, const std::vector<RimSquare>& rim) const {
    std::size_t count = 0;
    for (const LatticeElement& square : squares_round(edge_of(shocks_[s], parts_))) {
      const auto found = std::lower_bound(rim.begin(), rim.end(), RimSquare{square, 0});
      count += found != rim.end() && found->first == square ? 1 : 0;
    }
    return count;
  }

  const SolidParts& parts_;
  const std::vector<ChordShock>& shocks_;
  const ChordPruningOptions& options_;
  const EdgeCells cells_;
  DisjointSets pieces_;               // of shocks; the least member stands for its piece
  std::vector<std::uint32_t> owner_;  // per shock: a shock of the piece it is kept with, kNone if dropped
  std::vector<double> min_erosion_;   // per part
  SignificantShocks result_;
};

}  // namespace

SignificantShocks significant_shocks(const Lattice& lattice, const SolidParts& parts,
                                     const std::vector<ChordShock>& candidates,
                                     const ChordPruningOptions& options) {
  require_within(options.significance, 0, 1, "the significance must lie between 0 and 1");
  require_within(options.strong_turn, 0, 1, "the turn of strong shocks must lie between 0 and 1");
  require_within(options.min_erosion, 0, 1,
                 "the least erosion must be a share of the volume between 0 and 1");
  require_within(options.near_cost, 0, std::numeric_limits<double>::max(), "the cost must be a number >= 0");
  return Pruning(lattice, parts, candidates, options).run();
}

}  // namespace affskel::core
