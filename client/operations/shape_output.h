#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "affskel/v1/types.pb.h"
#include "base/atomic_file.h"
#include "client/files/format.h"
#include "client/files/write/shape_writer.h"

namespace affskel::client {

/// The file of a shape, opened before its artefact is computed, so that a path which cannot be written fails at
/// once.
class ShapeOutput {
 public:
  /// write_points, write_surface or write_curve.
  using WriteShape = void (&)(FileFormat format, const ShapeFile& shape,
                              const std::vector<std::string>& comments, const WriteBytes& write);
  using Writer = std::function<void(const std::vector<std::string>& comments, const WriteBytes& write)>;

  /// How its comments tell of a shape.
  struct Told {
    std::string what;                              ///< e.g. "affine skeleton"
    std::string key, how;                          ///< a line on the parameters that made it
    const v1::SkeletonQuality* quality = nullptr;  ///< a line for each figure
  };

  /// @throws ClientError kUsage when the destination is none of the formats.
  ShapeOutput(const Destination& destination, std::span<const FileFormat> formats, const char* what)
      : format_(choose_format(destination, formats, what)), file_(destination.file) {}

  FileFormat format() const { return format_; }

  /// Writes the file and gives it its name.
  void write(WriteShape writer, const ShapeFile& shape, const v1::Job& job, const Told& told);
  void write_by(const Writer& writer, const v1::Job& job, const Told& told);

 private:
  const FileFormat format_;
  base::AtomicFile file_;
};

}  // namespace affskel::client
