// Notation.  p: a place; f(d) = chord(p, d); K directions, the vertices of a geodesic sphere; a row holds the
// chords of a block of places along one direction.
//
// Why the nearest directions stand for the normals.  The normals only name two basins: descent leaves them
// anyway, for those of a sheet's vertex are means over its cell.  And minima and pass are then sampled alike,
// each too high by about the curvature of f times the squared distance of neighbours / 8, which cancels in
// their quotient where a valley leads from one normal to the other; exact minima beside a sampled pass would
// give every limb a barrier.
#include "core/barrier/barriers.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>

#include "core/barrier/lowest_pass.h"
#include "core/base/parallel.h"
#include "core/base/require.h"
#include "core/base/unit.h"
#include "core/erosion/join_tree.h"
#include "core/erosion/place_chords.h"
#include "core/mesh/geodesic_sphere.h"

namespace affskel::core {
namespace {

std::uint32_t sphere_frequency(std::uint32_t directions) {
  std::uint32_t f = 1;
  while (10 * f * f + 2 < directions) ++f;
  return f;
}

// The directions: neighbours, and where they point.
class Sphere {
 public:
  Sphere(std::uint32_t directions, const Matrix3& frame)
      : Sphere(geodesic_sphere(sphere_frequency(directions)), frame) {}

  std::size_t size() const { return even_.size(); }
  const Vec3& operator[](std::size_t i) const { return mesh_normals_[i]; }
  const Adjacency& graph() const { return graph_; }

  // The direction nearest to a normal of the mesh, in the frame, where the sphere is even.
  std::uint32_t nearest(const Vec3& normal) const {
    const Vec3 n = transposed_times(frame_, normal);
    std::uint32_t best = 0;
    for (std::uint32_t i = 1; i < even_.size(); ++i) {
      if (dot(n, even_[i]) > dot(n, even_[best])) best = i;
    }
    return best;
  }

 private:
  Sphere(const Mesh& sphere, const Matrix3& frame)
      : frame_(frame), even_(sphere.points), graph_(neighbours(sphere.points.size(), sphere.triangles)) {
    mesh_normals_ = even_;
    if (frame == kIdentity3) return;
    const Matrix3 map = inverse_transposed(frame);
    for (Vec3& n : mesh_normals_) n = unit(map * n);
  }

  Matrix3 frame_;
  std::vector<Vec3> even_, mesh_normals_;
  Adjacency graph_;
};

class Barriers {
 public:
  Barriers(const Solid& solid, std::span<const SheetPlace> places, const BarrierOptions& options)
      : places_(places),
        options_(options),
        sphere_(options.directions, options.frame),
        trees_(solid, options.threads),
        chords_(solid, positions(places), options.threads) {
    builders_.resize(std::max(1U, options.threads));
    for (auto& builder : builders_) {
      builder = std::make_unique<JoinTreeBuilder>(trees_, JoinTreeOptions{solid.self_intersecting});
    }
  }

  std::vector<double> run() {
    std::vector<double> result(places_.size(), 0);
    const std::size_t room = std::max<std::size_t>(1, options_.memory / (sizeof(float) * sphere_.size()));
    for (std::size_t begin = 0; begin < places_.size(); begin += room) {
      const std::size_t count = std::min(room, places_.size() - begin);
      fill_rows(begin, count);
      parallel_ranges(options_.threads, count, [&](std::size_t from, std::size_t to) {
        Basins basins(*this);
        for (std::size_t i = from; i < to; ++i) result[begin + i] = basins.barrier(begin + i, i, count);
      });
    }
    return result;
  }

 private:
  static std::vector<Vec3> positions(std::span<const SheetPlace> places) {
    std::vector<Vec3> list;
    list.reserve(places.size());
    for (const SheetPlace& place : places) list.push_back(place.position);
    return list;
  }

  // Row after row, so that the places of a row, which lie beside each other, climb the same tree.
  void fill_rows(std::size_t begin, std::size_t count) {
    rows_.resize(sphere_.size() * count);
    const double margin = 2 * trees_.volume_tolerance();
    std::atomic<std::size_t> next{0};
    parallel_for(static_cast<unsigned>(builders_.size()), builders_.size(), [&](std::size_t thread) {
      try {
        for (std::size_t d = next++; d < sphere_.size(); d = next++) {
          throw_if_stopped(options_.context);
          chords_.along(builders_[thread]->build(sphere_[d]), sphere_[d], begin, margin,
                        std::span(rows_).subspan(d * count, count));
        }
      } catch (...) {
        next = sphere_.size();  // the other threads need not go on
        throw;
      }
    });
  }

  // f of one place, and its basins.  One per thread.
  class Basins {
   public:
    explicit Basins(const Barriers& owner)
        : owner_(owner), pass_(owner.sphere_.graph()), f_(owner.sphere_.size()) {}

    // @param column of the place in its rows, which are `count` wide.
    double barrier(std::size_t place, std::size_t column, std::size_t count) {
      const SheetPlace& at = owner_.places_[place];
      if (!owner_.chords_.inside(place) || at.normal_a == Vec3{} || at.normal_b == Vec3{}) return 0;
      for (std::size_t d = 0; d < f_.size(); ++d) f_[d] = owner_.rows_[d * count + column];
      const Adjacency& graph = owner_.sphere_.graph();
      const std::uint32_t a = minimum_below(graph, f_, owner_.sphere_.nearest(at.normal_a)),
                          b = minimum_below(graph, f_, owner_.sphere_.nearest(at.normal_b));
      const double low = static_cast<double>(std::max(f_[a], f_[b]));
      if (a == b || low <= 0) return 0;
      return static_cast<double>(pass_.between(f_, a, b)) / low - 1;
    }

   private:
    const Barriers& owner_;
    LowestPass pass_;
    std::vector<float> f_;
  };

  std::span<const SheetPlace> places_;
  BarrierOptions options_;
  Sphere sphere_;
  TreeInput trees_;
  PlaceChords chords_;
  std::vector<std::unique_ptr<JoinTreeBuilder>> builders_;
  std::vector<float> rows_;  // direction by direction
};

}  // namespace

std::vector<double> barriers(const Solid& solid, std::span<const SheetPlace> places,
                             const BarrierOptions& options) {
  require_within(options.directions, 12, 1 << 20, "barriers take 12 to 2^20 directions");
  require_within(static_cast<double>(options.memory), 1, HUGE_VAL, "barriers need memory");
  require_within(std::abs(determinant(options.frame)), 1e-300, 1e300, "the frame must not be singular");
  if (places.empty()) return {};
  return Barriers(solid, places, options).run();
}

}  // namespace affskel::core
