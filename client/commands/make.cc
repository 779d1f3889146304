#include <CLI/CLI.hpp>
#include <functional>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <type_traits>

#include "base/atomic_file.h"
#include "base/number_text.h"
#include "client/cli/value_checks.h"
#include "client/commands/commands.h"
#include "client/commands/shared/destination.h"
#include "client/files/format.h"
#include "client/files/write/shape_writer.h"
#include "core/shapes/body.h"
#include "core/shapes/shapes.h"

namespace affskel::client {
namespace {

// What the options say.  Lengths in mesh units, sized so that a lattice spacing of 200 suits.
struct MakeOptions {
  std::function<core::Mesh()> shape;
  std::string output;
  std::uint32_t torus_triangles = 256;
  double major = 4000, minor = 2000;
  double radius = 3000;
  std::uint32_t triangles = 1280;                 // sphere, ellipsoid: at least
  std::vector<double> axes = {4000, 3000, 2000};  // ellipsoid
  std::vector<double> size = {5000, 4000, 3000};  // box
  std::uint32_t divisions = 1;                    // box
  double cylinder_radius = 2000, cylinder_height = 6000;
  double cone_radius = 3000, cone_height = 6000;
  std::uint32_t segments = 64;  // cylinder, cone
  double edge = 8000;           // tetrahedron
  std::uint32_t body_triangles = 500;
  double body_height = 18000;
};

void run_make(Console& console, const MakeOptions& options) {
  const Destination destination = destination_of(options.output, options.output == "-" ? "off" : "", console);
  const FileFormat format = choose_format(destination, surface_formats(), "shape");
  ShapeFile shape;
  try {
    shape = shape_of(options.shape());
  } catch (const core::CoreError& error) {
    throw error_from_core(error, "");
  }
  base::AtomicFile file(destination.file);
  write_into(file, [&](const WriteBytes& write) { write_surface(format, shape, {}, write); });
  file.commit();
  console.note("wrote " + destination.name() + " (" +
               base::counted(shape.mesh().triangles.size(), "triangle") + ")");
  console.document({{"file", options.output},
                    {"vertices", shape.mesh().points.size()},
                    {"triangles", shape.mesh().triangles.size()}});
}

// A shape is a command under `make`; choosing it chooses how the mesh is made.
CLI::App* shape(CLI::App* make, MakeOptions& options, const std::string& name, const std::string& description,
                std::function<core::Mesh()> mesh) {
  CLI::App* command = make->add_subcommand(name, description);
  command->group("Shapes");
  command->callback([&options, mesh = std::move(mesh)] { options.shape = mesh; });
  command
      ->add_option("-o,--output", options.output,
                   "File to write (.off .ply .obj .stl .vtp), or - for OFF on stdout")
      ->required()
      ->type_name("FILE");
  command->footer("Example:\n  affskel-client make " + name + " -o " + name + ".off");
  return command;
}

template <typename T>
CLI::Validator above_zero() {
  if constexpr (std::is_integral_v<T>)
    return whole_number(1, std::numeric_limits<T>::max());
  else
    return positive_number();
}

template <typename T>
void dimension(CLI::App* command, const std::string& name, T& value, const std::string& description,
               const char* type) {
  command->add_option(name, value, description)
      ->check(above_zero<T>())
      ->capture_default_str()
      ->type_name(type);
}

void triple(CLI::App* command, const std::string& name, std::vector<double>& values,
            const std::string& description) {
  command->add_option(name, values, description)
      ->delimiter(',')
      ->expected(3)
      ->check(positive_number())
      ->capture_default_str()
      ->type_name("A,B,C");
}

}  // namespace

void add_make(CommandLine& line) {
  const auto options = std::make_shared<MakeOptions>();
  MakeOptions& o = *options;
  CLI::App* make = line.add("make", "Write a test shape; sizes suit --spacing 200",
                            "  affskel-client make body --triangles 500 -o body.off\n"
                            "  affskel-client make torus --triangles 256 -o torus.off\n"
                            "  affskel-client make box --size 3,2,1 -o - | head -n 2",
                            [options](Context& context) { run_make(context.console(), *options); });
  make->require_subcommand(1);
  CLI::App* torus = shape(make, o, "torus", "Torus round the z axis",
                          [&o] { return core::make_torus(o.major, o.minor, o.torus_triangles); });
  dimension(torus, "--triangles", o.torus_triangles, "Exactly this many (even, >= 18)", "N");
  dimension(torus, "--major", o.major, "Radius of the circle inside the tube", "R");
  dimension(torus, "--minor", o.minor, "Radius of the tube", "R");
  CLI::App* sphere = shape(make, o, "sphere", "Geodesic sphere about the origin",
                           [&o] { return core::make_sphere(o.radius, o.triangles); });
  dimension(sphere, "--radius", o.radius, "Radius", "R");
  dimension(sphere, "--triangles", o.triangles, "At least this many", "N");
  CLI::App* ellipsoid = shape(make, o, "ellipsoid", "Ellipsoid about the origin", [&o] {
    return core::make_ellipsoid(o.axes.at(0), o.axes.at(1), o.axes.at(2), o.triangles);
  });
  triple(ellipsoid, "--axes", o.axes, "Semi-axes along x, y, z");
  dimension(ellipsoid, "--triangles", o.triangles, "At least this many", "N");
  CLI::App* box = shape(make, o, "box", "Axis-parallel box with a corner at the origin", [&o] {
    return core::make_box(o.size.at(0), o.size.at(1), o.size.at(2), o.divisions);
  });
  triple(box, "--size", o.size, "Edges along x, y, z");
  dimension(box, "--divisions", o.divisions, "Each face is cut into 2 N^2 triangles", "N");
  CLI::App* cylinder = shape(make, o, "cylinder", "Prism round the z axis", [&o] {
    return core::make_cylinder(o.cylinder_radius, o.cylinder_height, o.segments);
  });
  dimension(cylinder, "--radius", o.cylinder_radius, "Radius", "R");
  dimension(cylinder, "--height", o.cylinder_height, "Height", "H");
  dimension(cylinder, "--segments", o.segments, "Sides (>= 3)", "N");
  CLI::App* cone = shape(make, o, "cone", "Pyramid round the z axis, tip up",
                         [&o] { return core::make_cone(o.cone_radius, o.cone_height, o.segments); });
  dimension(cone, "--radius", o.cone_radius, "Radius of the base", "R");
  dimension(cone, "--height", o.cone_height, "Height", "H");
  dimension(cone, "--segments", o.segments, "Sides (>= 3)", "N");
  CLI::App* tetrahedron =
      shape(make, o, "tetrahedron", "Regular tetrahedron", [&o] { return core::make_tetrahedron(o.edge); });
  dimension(tetrahedron, "--edge", o.edge, "Edge", "A");
  CLI::App* body = shape(make, o, "body", "Standing human body, z up, facing -y", [&o] {
    return core::make_body({o.body_triangles, o.body_height});
  });
  dimension(body, "--triangles", o.body_triangles, "Exactly this many (even, 200 .. 200000)", "N");
  dimension(body, "--height", o.body_height, "From sole to crown", "H");
}

}  // namespace affskel::client
