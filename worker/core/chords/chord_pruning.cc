// Step 3 of chord_pruning.h joins pieces as cheapest_ways.h tells.  A shock costs 1 / (r w): 1 for opposite
// normals, 4 at 60 degrees, 100 and more between two facets.
//
// The significance of 0.005, at height / 190 on 11 bodies of 292 to 8560 triangles, leaves one component on
// all in the frame `axis` and on nine in `affine`; 0.02 leaves one on all in both.
#include "core/chords/chord_pruning.h"

#include <algorithm>
#include <functional>
#include <utility>

#include "core/base/cheapest_ways.h"
#include "core/base/disjoint_sets.h"
#include "core/base/none.h"
#include "core/base/require.h"
#include "core/chords/chord_edge.h"
#include "core/contour/edge_cells.h"

namespace affskel::core {
namespace {

double weight(const ChordShock& shock) {
  return squares_of(shock) * shock.strength * shock.turn;
}

double cost(const ChordShock& shock) {
  return 1 / (shock.strength * shock.turn);
}

// The cheapest path from every cell to a piece, and the paths between pieces that follow from them.  A piece
// is named by one of its shocks.  A step of a path is named by 4 s + n: through shock s, from the n-th cell
// round its edge.
class Paths {
 public:
  struct Path {
    double cost;
    std::uint32_t shock, a, b;  // crosses from cell a through the shock to cell b
    friend bool operator<(const Path& p, const Path& q) { return p.cost < q.cost; }
  };

  // piece: per cell, kNone where there is none.
  Paths(const std::vector<ChordShock>& shocks, const EdgeCells& cells, std::vector<std::uint32_t> piece)
      : shocks_(shocks), cells_(cells), ways_(std::move(piece)) {
    ways_.find([&](std::uint32_t cell, const auto& go) {
      for (const std::uint32_t s : cells.edges[cell]) {
        const auto& ring = cells.ring[s];
        const auto n = static_cast<std::uint32_t>(std::find(ring.begin(), ring.end(), cell) - ring.begin());
        for (const std::uint32_t next : ring) go(next, cost(shocks[s]), 4 * s + n);
      }
    });
  }

  std::uint32_t piece(std::uint32_t cell) const { return ways_.source[cell]; }

  // Joins pieces by the cheapest paths that take(path) takes.
  template <class Take>
  void join(DisjointSets& pieces, const Take& take) const {
    std::vector<Path> paths;
    for (std::uint32_t s = 0; s < shocks_.size(); ++s) {
      for (std::uint32_t a : cells_.ring[s]) {
        for (std::uint32_t b : cells_.ring[s]) {
          if (a < b && piece(a) != kNone && piece(b) != kNone && piece(a) != piece(b))
            paths.push_back({ways_.cost[a] + cost(shocks_[s]) + ways_.cost[b], s, a, b});
        }
      }
    }
    const auto ends = [&](const Path& path) { return std::pair{piece(path.a), piece(path.b)}; };
    take_cheapest(std::move(paths), pieces, ends, take);
  }

  // All shocks on a path, from piece to piece.
  template <class Visit>
  void for_each_shock(const Path& path, Visit visit) const {
    visit(path.shock);
    for (const std::uint32_t end : {path.a, path.b}) {
      for (std::uint32_t step = ways_.step[end]; step != kNone;) {
        visit(step / 4);
        step = ways_.step[cells_.ring[step / 4][step % 4]];
      }
    }
  }

 private:
  const std::vector<ChordShock>& shocks_;
  const EdgeCells& cells_;
  CheapestWays ways_;
};

class Pruning {
 public:
  Pruning(const Lattice& lattice, const SolidParts& parts, const std::vector<ChordShock>& shocks,
          double significance, const ChordConstants& constants)
      : shocks_(shocks),
        significance_(significance),
        constants_(constants),
        cells_(cells_of(lattice, parts, shocks)),
        pieces_(shocks.size()),
        owner_(shocks.size(), kNone) {
    const double cell = lattice.spacing * lattice.spacing * lattice.spacing;
    for (std::uint32_t p = 0; p < parts.count(); ++p) {
      min_erosion_.push_back(constants.min_erosion * (parts.points(p) * cell));
    }
  }

  SignificantShocks run() {
    count();
    join_touching();
    keep_significant();
    join_kept();
    for (std::uint32_t s = 0; s < shocks_.size(); ++s) {
      if (kept(s)) result_.shocks.push_back(shocks_[s]);
    }
    return std::move(result_);
  }

 private:
  std::uint32_t part(std::uint32_t s) const { return cells_.part[cells_.ring[s][0]]; }

  bool wide(std::uint32_t s) const { return shocks_[s].turn >= constants_.strong_turn; }

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
      for (std::uint32_t s : cells_.edges[cell]) {
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
    paths.join(pieces_, [&](const Paths::Path& path) {
      if (path.cost > constants_.near_cost) return false;
      used.push_back(path);
      return true;
    });
    std::vector<double> mass(shocks_.size(), 0), whole(min_erosion_.size(), 0);
    for (std::uint32_t s = 0; s < shocks_.size(); ++s) {
      if (!strong(s)) continue;
      mass[pieces_.find(s)] += weight(shocks_[s]);
      whole[part(s)] += weight(shocks_[s]);
    }
    const auto significant = [&](std::uint32_t s) {
      return mass[pieces_.find(s)] >= significance_ * whole[part(s)];
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
    paths.join(pieces_, [&](const Paths::Path& path) {
      ++result_.bridges;
      keep_path(paths, path);
      return true;
    });
  }

  const std::vector<ChordShock>& shocks_;
  double significance_;
  const ChordConstants& constants_;
  const EdgeCells cells_;
  DisjointSets pieces_;               // of shocks; the least member stands for its piece
  std::vector<std::uint32_t> owner_;  // per shock: a shock of the piece it is kept with, kNone if dropped
  std::vector<double> min_erosion_;   // per part
  SignificantShocks result_;
};

}  // namespace

SignificantShocks significant_shocks(const Lattice& lattice, const SolidParts& parts,
                                     const std::vector<ChordShock>& candidates, double significance,
                                     const ChordConstants& constants) {
  require_within(significance, 0, 1, "the significance must lie between 0 and 1");
  return Pruning(lattice, parts, candidates, significance, constants).run();
}

}  // namespace affskel::core
