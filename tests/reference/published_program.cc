#include "published_program.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>

#include "core/base/stopwatch.h"
#include "open_surface.h"

namespace affskel::reference {
namespace {

using core::Mesh;
using core::Stopwatch;
using core::Triangle;
using core::Vec3;

// Relative to the size of the solid.
constexpr double kOnPlane = 1e-12;
constexpr double kInwards = 1e-9;

struct Bounds {
  Vec3 low, high;
};

Bounds bounds_of(const Mesh& mesh) {
  Bounds b{mesh.points.at(0), mesh.points.at(0)};
  for (const Vec3& p : mesh.points) {
    b.low = {std::min(b.low.x, p.x), std::min(b.low.y, p.y), std::min(b.low.z, p.z)};
    b.high = {std::max(b.high.x, p.x), std::max(b.high.y, p.y), std::max(b.high.z, p.z)};
  }
  return b;
}

// A component of the solid below a plane: its surface without the lid.
struct Piece {
  std::vector<Triangle> triangles;
  double volume = 0;
};

// The stretch of the ray from x_i that lies inside, in distances from x_i.
struct Stay {
  double entry = 0, exit = 0;
};

class Program {
 public:
  Program(const Mesh& mesh, const PublishedOptions& options)
      : mesh_(mesh), options_(options), bounds_(bounds_of(mesh)), random_(options.seed) {
    size_ = norm(bounds_.high - bounds_.low);
    volume_ = boundary_integral(mesh.points, mesh.triangles, bounds_.low);
  }

  PublishedField run() {
    Stopwatch watch;
    generate_points();
    field_.points_s = watch.lap();
    if (options_.triangles.empty()) {
      for (std::uint32_t i = 0; i < mesh_.triangles.size(); ++i) advance_from(i);
    } else {
      for (const std::uint32_t i : options_.triangles) advance_from(i);
    }
    field_.erosion_s = watch.lap();
    return std::move(field_);
  }

 private:
  void generate_points() {
    const Vec3 side = bounds_.high - bounds_.low, centre = 0.5 * (bounds_.low + bounds_.high);
    const auto count = [&](double length) {
      const double steps = length / options_.spacing * (1 - 1e-9);
      return steps > 1 ? 2 * std::ceil((steps - 1) / 2) : 1;
    };
    const double nx = count(side.x), ny = count(side.y), nz = count(side.z);
    const auto at = [&](double middle, double i, double n) {
      return middle + options_.spacing * (i - (n - 1) / 2);
    };
    for (double i = 0; i < nx; ++i) {
      for (double j = 0; j < ny; ++j) {
        for (double k = 0; k < nz; ++k) {
          const Vec3 x = {at(centre.x, i, nx), at(centre.y, j, ny), at(centre.z, k, nz)};
          if (contains(mesh_.points, mesh_.triangles, x, nullptr, random_)) field_.points.push_back(x);
        }
      }
    }
    field_.erosion.assign(field_.points.size(), std::numeric_limits<double>::infinity());
    field_.triangle.assign(field_.points.size(), PublishedField::kNone);
  }

  // The loop 4 of the published listing, for triangle i.
  void advance_from(std::uint32_t i) {
    const Triangle& t = mesh_.triangles[i];
    const Vec3 &a = mesh_.points[t[0]], &b = mesh_.points[t[1]], &c = mesh_.points[t[2]];
    const Vec3 outward = cross(b - a, c - a);
    if (norm(outward) == 0) return;
    const Vec3 n = (-1 / norm(outward)) * outward;
    Vec3 x = (1.0 / 3) * (a + b + c);
    std::optional<std::vector<Stay>> stays = stays_of(i, x, n);
    for (double aside = 1e-7; !stays && aside < 0.1; aside *= 2) {
      x = x + aside * ((a - x) + 0.3 * (b - x));  // not along a median, which may face a side all the way
      stays = stays_of(i, x, n);
    }
    if (!stays) throw std::logic_error("published program: no ray from the triangle's inside is clear");
    for (const Stay& stay : *stays) {
      if (!advance_within(i, x, n, stay)) break;
    }
  }

  // Entries and exits of the ray from x, a point of triangle i; nothing when it grazes a side.
  std::optional<std::vector<Stay>> stays_of(std::uint32_t i, const Vec3& x, const Vec3& n) const {
    std::vector<double> crossings = {0};
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
      if (t == i) continue;
      const Triangle& corner = mesh_.triangles[t];
      const auto hit = meet(x, n, mesh_.points[corner[0]], mesh_.points[corner[1]], mesh_.points[corner[2]]);
      if (!hit) continue;
      if (hit->grazes) return {};
      crossings.push_back(hit->distance);
    }
    if (crossings.size() % 2 != 0) return {};
    std::sort(crossings.begin(), crossings.end());
    std::vector<Stay> stays;
    for (std::size_t k = 0; k < crossings.size(); k += 2) stays.push_back({crossings[k], crossings[k + 1]});
    return stays;
  }

  // Planes from entry to exit; whether to go on after that.
  bool advance_within(std::uint32_t i, const Vec3& x, const Vec3& n, const Stay& stay) {
    const double first = stay.entry + kInwards * size_;
    std::optional<double> before;  // the volume at the last plane
    for (std::uint64_t l = 0;; ++l) {
      const double distance = first + static_cast<double>(l) * options_.step;
      if (distance >= stay.exit) return true;
      const Vec3 advanced = x + distance * n;
      const Plane plane = {n, dot(n, advanced)};
      const OpenSurface below = cut_and_reconstruct(mesh_, plane, kOnPlane * size_);
      ++field_.planes;
      const std::optional<Piece> piece = piece_of(below, plane, advanced);
      if (piece && before) sweep(i, below, *piece, plane, *before);
      if (piece && piece->volume >= volume_ / 2) return false;
      before = piece ? std::optional(piece->volume) : std::nullopt;
    }
  }

  std::optional<Piece> piece_of(const OpenSurface& below, const Plane& plane, const Vec3& x) {
    std::vector<Piece> outer, inner;
    for (std::vector<Triangle>& triangles : components(below.triangles)) {
      const double volume = boundary_integral(below.points, triangles, x);
      (volume < 0 ? inner : outer).push_back({std::move(triangles), volume});
    }
    for (const Piece& dent : inner) give_to_owner(below, plane, dent, outer);
    for (Piece& piece : outer) {
      if (contains(below.points, piece.triangles, x, &plane, random_)) return std::move(piece);
    }
    return {};
  }

  // An inner surface belongs to the smallest outer one that holds it; its own part in the plane decides
  // nothing, so a corner well below stands for it.
  void give_to_owner(const OpenSurface& below, const Plane& plane, const Piece& dent,
                     std::vector<Piece>& outer) {
    Vec3 lowest = below.points[dent.triangles[0][0]];
    for (const Triangle& t : dent.triangles) {
      for (const std::uint32_t v : t) {
        if (dot(plane.d, below.points[v]) < dot(plane.d, lowest)) lowest = below.points[v];
      }
    }
    Piece* owner = nullptr;
    for (Piece& piece : outer) {
      if (owner != nullptr && piece.volume >= owner->volume) continue;
      if (contains(below.points, piece.triangles, lowest, &plane, random_)) owner = &piece;
    }
    if (owner == nullptr) return;
    owner->triangles.insert(owner->triangles.end(), dent.triangles.begin(), dent.triangles.end());
    owner->volume += dent.volume;
  }

  // Points of the piece that the plane has passed in the last step.
  void sweep(std::uint32_t i, const OpenSurface& below, const Piece& piece, const Plane& plane,
             double before) {
    for (std::size_t p = 0; p < field_.points.size(); ++p) {
      const double depth = plane.height - dot(plane.d, field_.points[p]);
      const bool passed = depth <= options_.step;
      if (depth < 0 || !(passed || options_.every_point)) continue;
      const bool held = contains(below.points, piece.triangles, field_.points[p], &plane, random_);
      if (!held || !passed) continue;
      const double volume = piece.volume + (before - piece.volume) * (depth / options_.step);
      if (volume >= field_.erosion[p]) continue;
      field_.erosion[p] = volume;
      field_.triangle[p] = i;
    }
  }

  const Mesh& mesh_;
  const PublishedOptions& options_;
  Bounds bounds_;
  double size_ = 0;    // the bounding box's diagonal
  double volume_ = 0;  // v0
  std::mt19937_64 random_;
  PublishedField field_;
};

bool positive(double value) {
  return std::isfinite(value) && value > 0;
}

}  // namespace

PublishedField published_program(const Mesh& mesh, const PublishedOptions& options) {
  if (!positive(options.spacing) || !positive(options.step))
    throw std::invalid_argument("published program: spacing and step must be finite and > 0");
  for (const std::uint32_t i : options.triangles) {
    if (i >= mesh.triangles.size())
      throw std::invalid_argument("published program: no triangle " + std::to_string(i));
  }
  return Program(mesh, options).run();
}

}  // namespace affskel::reference
