#include "clip_oracle.h"

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/clip.h>
#include <CGAL/Polygon_mesh_processing/connected_components.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Side_of_triangle_mesh.h>
#include <CGAL/Surface_mesh.h>

#include <array>
#include <cstddef>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace affskel::reference {
namespace {

using core::Vec3;
using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using Point = Kernel::Point_3;
using Plane = Kernel::Plane_3;
using Surface = CGAL::Surface_mesh<Point>;
using Face = Surface::Face_index;
namespace pmp = CGAL::Polygon_mesh_processing;

Point exact_point(const Vec3& p) {
  return {p.x, p.y, p.z};
}

// to_double of a lazy number is good to 1e-5 only until its exact value has been asked for.
Vec3 rounded(const Point& p) {
  const auto& e = CGAL::exact(p);
  return {CGAL::to_double(e.x()), CGAL::to_double(e.y()), CGAL::to_double(e.z())};
}

std::array<Surface::Vertex_index, 3> corners(const Surface& surface, Face face) {
  const auto edge = surface.halfedge(face);
  return {surface.source(edge), surface.target(edge), surface.target(surface.next(edge))};
}

Surface to_surface(const core::Mesh& mesh) {
  Surface surface;
  std::vector<Surface::Vertex_index> vertex;
  for (const Vec3& p : mesh.points) vertex.push_back(surface.add_vertex(exact_point(p)));
  for (const core::Triangle& t : mesh.triangles) {
    if (surface.add_face(vertex[t[0]], vertex[t[1]], vertex[t[2]]) == Surface::null_face())
      throw std::invalid_argument("clip oracle: the mesh is not an oriented manifold");
  }
  if (!CGAL::is_closed(surface) || !pmp::does_bound_a_volume(surface) || !pmp::is_outward_oriented(surface))
    throw std::invalid_argument("clip oracle: the mesh does not bound a volume from outside");
  return surface;
}

// One closed surface of the cut volume: outer when its volume is > 0, else the wall of a cavity.
struct Shell {
  std::vector<Face> faces;
  double volume = 0;
};

}  // namespace

class ClipOracle::Cutter {
 public:
  explicit Cutter(const core::Mesh& mesh) : whole_(to_surface(mesh)), reference_(mesh.points.at(0)) {}

  double chord(const Vec3& x, const Vec3& d) {
    const Point at = exact_point(x);
    if (!(plane_ && normal_ == d && plane_->has_on(at))) cut(x, d);
    return volume_of_solid(shell_at(at, x, d));
  }

  std::uint64_t cuts() const { return cuts_; }

 private:
  static std::string in_words(const std::string& why, const Vec3& x, const Vec3& d) {
    std::ostringstream text;
    text.precision(17);
    text << "clip oracle: " << why << " at x = (" << x.x << ", " << x.y << ", " << x.z << "), d = (" << d.x
         << ", " << d.y << ", " << d.z << ")";
    return text.str();
  }

  void cut(const Vec3& x, const Vec3& d) {
    ++cuts_;
    normal_ = d;
    plane_.reset();
    const Plane plane(exact_point(x), Kernel::Vector_3(d.x, d.y, d.z));
    piece_ = whole_;
    if (!pmp::clip(piece_, plane, CGAL::parameters::clip_volume(true)))
      throw CutRefused(in_words("the piece pinches along an edge", x, d));
    if (!CGAL::is_closed(piece_)) throw std::runtime_error(in_words("CGAL leaves the cut open", x, d));
    plane_ = plane;
    split();
  }

  void split() {
    auto component = piece_.add_property_map<Face, std::size_t>("f:component").first;
    shells_.assign(pmp::connected_components(piece_, component), {});
    for (const Face face : piece_.faces()) {
      Shell& shell = shells_[component[face]];
      shell.faces.push_back(face);
      const auto [a, b, c] = corners(piece_, face);
      const Vec3 p = rounded(piece_.point(a)) - reference_, q = rounded(piece_.point(b)) - reference_,
                 r = rounded(piece_.point(c)) - reference_;
      shell.volume += dot(cross(p, q), r) / 6;
    }
  }

  // The shell whose lid holds x: x lies inside V, so no other surface passes there.
  std::size_t shell_at(const Point& at, const Vec3& x, const Vec3& d) const {
    std::optional<std::size_t> found;
    for (std::size_t s = 0; s < shells_.size(); ++s) {
      if (!lid_holds(shells_[s], at)) continue;
      if (found) throw std::runtime_error(in_words("two pieces hold the point", x, d));
      found = s;
    }
    if (!found) throw std::runtime_error(in_words("no piece holds the point", x, d));
    return *found;
  }

  bool lid_holds(const Shell& shell, const Point& at) const {
    for (const Face face : shell.faces) {
      const auto [a, b, c] = corners(piece_, face);
      const Point &p = piece_.point(a), &q = piece_.point(b), &r = piece_.point(c);
      if (!plane_->has_on(p) || !plane_->has_on(q) || !plane_->has_on(r)) continue;
      if (Kernel::Triangle_3(p, q, r).has_on(at)) return true;
    }
    return false;
  }

  // Volume of outer shell `s` without its cavities.
  double volume_of_solid(std::size_t s) const {
    double volume = shells_[s].volume;
    for (std::size_t cavity = 0; cavity < shells_.size(); ++cavity) {
      if (shells_[cavity].volume < 0 && owner(cavity) == s) volume += shells_[cavity].volume;
    }
    return volume;
  }

  // The innermost outer shell round a cavity: of those that hold it the smallest.
  std::size_t owner(std::size_t cavity) const {
    std::size_t best = shells_.size();
    for (std::size_t s = 0; s < shells_.size(); ++s) {
      if (shells_[s].volume <= 0 || !holds(s, cavity)) continue;
      if (best == shells_.size() || shells_[s].volume < shells_[best].volume) best = s;
    }
    return best;
  }

  bool holds(std::size_t outer, std::size_t inner) const {
    Surface surface;
    for (const Face face : shells_[outer].faces) {
      const auto [a, b, c] = corners(piece_, face);
      // A soup will do: the test shoots rays and does not walk over the surface.
      surface.add_face(surface.add_vertex(piece_.point(a)), surface.add_vertex(piece_.point(b)),
                       surface.add_vertex(piece_.point(c)));
    }
    const CGAL::Side_of_triangle_mesh<Surface, Kernel> side(surface);
    for (const Face face : shells_[inner].faces) {
      const CGAL::Bounded_side place = side(piece_.point(corners(piece_, face)[0]));
      if (place != CGAL::ON_BOUNDARY) return place == CGAL::ON_BOUNDED_SIDE;
    }
    return false;
  }

  const Surface whole_;
  const Vec3 reference_;  // volumes are summed about this point
  Vec3 normal_;
  std::optional<Plane> plane_;  // of the last cut
  Surface piece_;
  std::vector<Shell> shells_;
  std::uint64_t cuts_ = 0;
};

ClipOracle::ClipOracle(const core::Mesh& mesh) : cutter_(std::make_unique<Cutter>(mesh)) {}
ClipOracle::~ClipOracle() = default;

double ClipOracle::chord(const Vec3& x, const Vec3& d) {
  return cutter_->chord(x, d);
}

std::uint64_t ClipOracle::cuts() const {
  return cutter_->cuts();
}

}  // namespace affskel::reference
