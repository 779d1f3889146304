#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "client/cli/affine_steps.h"

namespace affskel::client {

enum class Command {
  kSubmit,
  kList,
  kStatus,
  kWatch,
  kFetch,
  kSkeleton,
  kSurface,
  kErode,
  kCancel,
  kResume,
  kDelete,
  kServerInfo,
  kInspect,
  kMake,
  kRender,
  kCompare,
  kTransform,
  kPerturb,
  kView,
  kCompletions,
};

enum class Shape { kTorus, kSphere, kEllipsoid, kBox, kCylinder, kCone, kTetrahedron, kBody };

struct GlobalOptions {
  std::string server;  ///< empty = environment, configuration, embedded
  bool json = false;
  bool quiet = false;
};

struct SkeletonOptions {
  std::string operator_name;
  double threshold = 0;  ///< 0 = the operator's default
  bool given() const { return !operator_name.empty() || threshold > 0; }
};

struct SubmitOptions {
  std::string file;
  bool wait = false;
  std::string output_dir;  ///< empty = fetch nothing; otherwise implies wait
  double spacing = 0;      ///< mesh units; 0 = by points
  std::uint64_t points = 100000;
  std::string directions = "triangles";
  std::string frame = "axis";
  SkeletonOptions skeleton{"zucker-hummel"};
  std::string name;  ///< empty = the file's stem
  unsigned priority = 5;
  std::string request_id;
  std::string repair = "auto";
};

struct ListOptions {
  std::vector<std::string> states;
  std::string owner;
  unsigned limit = 50;
};

/// For every command about one job.
struct JobOptions {
  std::string job;
  std::string artifact;      ///< fetch
  std::string output;        ///< fetch, skeleton, surface, erode, render, view; "-" = standard output
  std::string format;        ///< fetch, skeleton, surface, erode; an extension, empty = the output's
  SkeletonOptions skeleton;  ///< skeleton, surface, render, view, fetch divergence; no operator: the job's
  double alpha = 0;          ///< surface; squared radius, 0 = from the spacing
  double fraction = 0;       ///< erode; level as a share of v0, 0 = not given
  double volume = 0;         ///< erode; level, mesh units cubed, 0 = not given
  std::string form;          ///< erode; "points" or "surface", empty = by the extension
  int width = 1600;          ///< render; pixels
};

struct MakeOptions {
  Shape shape = Shape::kTorus;
  std::string output;
  // Lengths in mesh units, sized so that a lattice spacing of 200 suits.
  std::uint32_t torus_triangles = 256;
  double major = 4000, minor = 2000;
  double radius = 3000;
  std::uint32_t triangles = 1280;                 ///< sphere, ellipsoid: at least
  std::vector<double> axes = {4000, 3000, 2000};  ///< ellipsoid
  std::vector<double> size = {5000, 4000, 3000};  ///< box
  std::uint32_t divisions = 1;                    ///< box
  double cylinder_radius = 2000, cylinder_height = 6000;
  double cone_radius = 3000, cone_height = 6000;
  std::uint32_t segments = 64;  ///< cylinder, cone
  double edge = 8000;           ///< tetrahedron
  std::uint32_t body_triangles = 500;
  double body_height = 18000;
};

struct CompareOptions {
  std::string a, b;
  double radius = 0;              ///< 0 = the voxel diagonal of the box
  std::string radii;              ///< comma-separated; empty = 0 .. 4 radius
  bool squared = false;           ///< radii are given and shown squared
  std::string solid;              ///< mesh for the chance level; empty = none
  std::string plot, output;       ///< SVG and CSV; empty = none
  std::uint64_t samples = 50000;  ///< points on a surface
};

struct TransformOptions {
  std::string file, output, format;
  std::vector<AffineStep> steps;  ///< in the order given
  bool inverse = false;
};

struct PerturbOptions {
  std::string file, output, format;
  std::string noise;            ///< share of the box diagonal, "0.5%" or "0.005"; empty = sigma
  std::optional<double> sigma;  ///< mesh units
  std::uint64_t seed = 1;
};

/// Everything the command line can say.
struct Options {
  GlobalOptions global;
  Command command = Command::kList;
  SubmitOptions submit;
  ListOptions list;
  JobOptions job;
  std::string inspect_file;
  MakeOptions make;
  CompareOptions compare;
  TransformOptions transform;
  PerturbOptions perturb;
  std::string shell;
};

}  // namespace affskel::client
