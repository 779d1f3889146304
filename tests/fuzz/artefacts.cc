// Artefacts, as a client takes them from a server that it need not trust.
#include "affskel/v1/types.pb.h"
#include "bytes.h"
#include "client/artifacts/field_decoder.h"
#include "client/artifacts/skeleton_points.h"
#include "client/artifacts/solid_parts.h"
#include "client/artifacts/surface.h"
#include "client/base/error.h"
#include "client/files/write/shape_writer.h"
#include "core/files/file_format.h"
#include "targets.h"

namespace affskel::fuzz {
namespace {

struct CountingReceiver final : client::FieldReceiver {
  void put(const client::FieldPoint&) override { ++points; }
  void finish() override {}
  std::uint64_t points = 0;
};

// What is taken for a surface can be written in every format that holds one.
void write_all(const client::ShapeFile& shape, std::span<const core::FileFormat> formats,
               decltype(client::write_surface)* write) {
  for (const core::FileFormat format : formats) {
    try {
      write(format, shape, {"a comment"}, [](std::string_view) {});
    } catch (const client::ClientError&) {
    }
  }
}

void read_field(Bytes& bytes) {
  v1::Lattice lattice;
  const std::string_view message = bytes.take(bytes.byte());
  lattice.ParseFromArray(message.data(), static_cast<int>(message.size()));
  const client::LatticePoints points(lattice);
  CountingReceiver receiver;
  v1::Directions directions;
  for (const double c : {0.0, 0.0, 1.0}) directions.add_xyz(c);
  client::FieldDecoder decoder(points, bytes.below(2) == 0 ? &directions : nullptr, receiver);
  while (!bytes.empty()) decoder.data(bytes.take(1 + bytes.byte()));
  decoder.finish();
  if (receiver.points != points.count()) throw Finding("a field of another number of points was taken");
}

void run(std::string_view input) {
  Bytes bytes(input);
  const unsigned which = bytes.below(5);
  try {
    if (which == 0) read_field(bytes);
    const std::string rest(bytes.rest());
    if (which == 1)
      write_all(client::shape_of(client::parse_skeleton(rest)), core::skeleton_formats(),
                client::write_points);
    if (which == 2)
      write_all(client::parse_surface(rest).shape, core::surface_formats(), client::write_surface);
    if (which == 3) {
      const v1::SolidParts parts = client::parse_solid_parts(rest);
      client::surface_of(parts);
    }
    if (which == 4)
      write_all(client::shape_of(client::parse_eroded_points(rest)), core::skeleton_formats(),
                client::write_points);
  } catch (const client::ClientError&) {
  }
}

v1::TriangleMesh triangle() {
  v1::TriangleMesh mesh;
  for (const double c : {0., 0., 0., 1., 0., 0., 0., 1., 0., 0., 0., 1.}) mesh.add_xyz(c);
  for (const std::uint32_t v : {0U, 1U, 2U}) mesh.add_corners(v);
  for (const std::uint32_t v : {2U, 3U}) mesh.add_segments(v);
  for (int v = 0; v < 4; ++v) {
    mesh.add_erosion(1);
    mesh.add_area(2);
    mesh.add_strength(3);
    mesh.add_ratio(0.5);
    mesh.add_kind(static_cast<std::uint32_t>(v));
    for (const double c : {0., 0., 1.}) {
      mesh.add_normal_a(c);
      mesh.add_normal_b(c);
    }
  }
  return mesh;
}

std::vector<std::string> seeds() {
  v1::Lattice lattice;
  for (int c = 0; c < 3; ++c) lattice.add_origin(c);
  for (const double c : {1., 0., 0., 0., 1., 0., 0., 0., 1.}) lattice.add_axes(c);
  for (const std::uint32_t n : {1U, 2U, 3U}) lattice.add_dims(n);
  lattice.add_run_start(1);
  lattice.add_run_length(2);
  const std::string grid = lattice.SerializeAsString();
  v1::SkeletonPoints points;
  points.add_point(1);
  for (const double c : {0., 0., 1.}) {
    points.add_xyz(c);
    points.add_normal(c);
  }
  points.add_erosion(1);
  points.add_direction(0);
  v1::SkeletonPoints skeleton = points;
  skeleton.add_divergence(8);
  v1::SolidParts parts;
  *parts.mutable_curve() = triangle();
  *parts.mutable_surface() = triangle();
  parts.add_triangle_part(1);
  parts.add_thickness(1);
  parts.add_parts()->set_kind(v1::PART_KIND_LINE);
  return {
      '\0' + std::string(1, static_cast<char>(grid.size())) + grid + '\0' + '\x27' + std::string(40, '\0'),
      '\1' + skeleton.SerializeAsString(), '\2' + triangle().SerializeAsString(),
      '\3' + parts.SerializeAsString(), '\4' + points.SerializeAsString()};
}

}  // namespace

const Target kArtefacts = {"artefacts", seeds, run, 5000};

}  // namespace affskel::fuzz
