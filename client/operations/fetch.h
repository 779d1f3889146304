#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "affskel/v1/types.pb.h"
#include "client/base/notice.h"
#include "client/connection/session.h"
#include "client/files/format.h"
#include "client/operations/skeleton_choice.h"

namespace affskel::client {

/// Which artefact of a job is wanted, with the parameters of those that have some, and where it goes.
struct FetchRequest {
  enum class Form { kByExtension, kPoints, kSurface };  // kSurface: a complex, with curves

  std::string job;
  std::string artifact;  ///< one of artifact_names()
  Destination destination;
  SkeletonChoice skeleton = {};  ///< of skeleton, surface, curve and divergence
  double alpha = 0;      ///< of a surface of points: squared radius, mesh units squared; 0 = from the spacing
  bool barrier = false;  ///< of a sheet: with the barrier at its vertices
  double min_barrier = 0;        ///< drop what has a vertex of a lower one; implies the barrier
  bool parts = false;            ///< of a field: with the part of the solid that each sample point lies in
  v1::ErodedParams eroded = {};  ///< no level: the default one
  /// Of a skeleton and an eroded solid.  By the extension: of a published operator points, of a sheet these where
  /// the format holds nothing else.
  Form form = Form::kByExtension;
};

/// An artefact of a job that was written into a file.
struct Fetched {
  Destination destination;
  std::string
      artifact;  ///< "field", "divergence", "skeleton", "surface", "curve", "thickness", "eroded", "mesh", "source"
  std::string unit;                            ///< what is counted: "point", "segment", "triangle" or "byte"
  std::uint64_t items = 0;                     ///< how many
  v1::Job job;                                 ///< as the server sent it along
  std::optional<std::uint64_t> segments = {};  ///< of curves, of a skeleton with triangles
  std::optional<v1::SkeletonQuality> quality =
      {};  ///< of a skeleton, a sheet, or the curve beside a thickness
  /// Of an eroded solid, mesh units cubed: what the surface encloses, or of points their share of the sample
  /// points times v0.
  std::optional<double> volume = {};
  Notices notices = {};  ///< that it is empty and why, and what the format does not hold
};

/// What can be fetched: "field", "divergence", "skeleton", "surface", "curve", "thickness", "eroded", "mesh",
/// "source".
std::vector<std::string> artifact_names();

/// The formats of an artefact, as extensions with the dot, each once; the first is a good one to begin with.
/// @throws ClientError kUsage for an unknown name.
std::vector<std::string> artifact_extensions(const std::string& name);

/// Fetches an artefact, computed first if need be, and writes it atomically.  The file is opened before, so
/// that a path which cannot be written fails at once.
/// @throws ClientError kUsage for an unknown artefact or a format that cannot hold it; as Session::fetch.
Fetched fetch(Session& session, const FetchRequest& request);

/// The format of a job's field that every ParaView and VTK opens in its place: .vti, or .vts where the
/// lattice is not parallel to the mesh's axes.
FileFormat open_field_format(const v1::Job& job);

/// An artefact in a file, the format by its extension, all else as it is by default.
FetchRequest one_file(const v1::Job& job, const std::string& artifact, const std::string& path);

/// What most people want of a job: its field in that format, STEM.field.vti or .vts, and its skeleton,
/// STEM.skeleton.vtp and .ply.
std::vector<FetchRequest> main_files(const v1::Job& job, const std::string& stem);

}  // namespace affskel::client
