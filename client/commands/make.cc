#include <nlohmann/json.hpp>

#include "client/commands/commands.h"
#include "client/commands/shared/destination.h"
#include "client/files/format.h"
#include "client/files/write/atomic_file.h"
#include "client/files/write/mesh_writer.h"
#include "core/base/number_text.h"
#include "core/shapes/body.h"
#include "core/shapes/shapes.h"

namespace affskel::client {
namespace {

core::Mesh make_shape(const MakeOptions& o) {
  switch (o.shape) {
    case Shape::kTorus:
      return core::make_torus(o.major, o.minor, o.torus_triangles);
    case Shape::kSphere:
      return core::make_sphere(o.radius, o.triangles);
    case Shape::kEllipsoid:
      return core::make_ellipsoid(o.axes.at(0), o.axes.at(1), o.axes.at(2), o.triangles);
    case Shape::kBox:
      return core::make_box(o.size.at(0), o.size.at(1), o.size.at(2), o.divisions);
    case Shape::kCylinder:
      return core::make_cylinder(o.cylinder_radius, o.cylinder_height, o.segments);
    case Shape::kCone:
      return core::make_cone(o.cone_radius, o.cone_height, o.segments);
    case Shape::kTetrahedron:
      return core::make_tetrahedron(o.edge);
    case Shape::kBody:
      break;
  }
  return core::make_body({o.body_triangles, o.body_height});
}

}  // namespace

void run_make(Console& console, const MakeOptions& options) {
  const Destination destination = destination_of(options.output, options.output == "-" ? "off" : "", console);
  const FileFormat format = choose_format(destination, surface_formats(), "shape");
  core::Mesh mesh;
  try {
    mesh = make_shape(options);
  } catch (const core::CoreError& error) {
    throw error_from_core(error, "");
  }
  AtomicFile file(destination.file);
  write_mesh(format, mesh, {}, file);
  file.commit();
  console.note("wrote " + destination.name() + " (" + core::counted(mesh.triangles.size(), "triangle") + ")");
  console.document(
      {{"file", options.output}, {"vertices", mesh.points.size()}, {"triangles", mesh.triangles.size()}});
}

}  // namespace affskel::client
