#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "core/files/file_format.h"

namespace affskel::client {

using core::extension_of;
using core::field_formats;
using core::FileFormat;
using core::skeleton_formats;
using core::surface_formats;

/// More of what can be written as which formats.
std::span<const FileFormat> divergence_formats();     // as fields
std::span<const FileFormat> parted_field_formats();   // as fields, but for dat
std::span<const FileFormat> thickness_formats();      // ply, vtp
std::span<const FileFormat> curve_file_formats();     // those of core, and as points csv and xyz
std::span<const FileFormat> skeleton_file_formats();  // surface_formats and skeleton_formats, best first
std::span<const FileFormat> picture_formats();        // png
std::span<const FileFormat> page_formats();           // html

/// The file's extension with the dot, in lower case; empty without one.
std::string lower_extension(const std::filesystem::path& file);

/// Where a result goes, and as what.
struct Destination {
  std::filesystem::path file;  ///< "-" is the standard output
  std::string format = {};     ///< an extension with or without its dot, in any case; empty = the file's

  bool is_stdout() const { return file == "-"; }
  /// The file for people.
  std::string name() const { return is_stdout() ? "standard output" : file.string(); }
  /// Of the format, else of the file: with the dot, in lower case; empty without one.
  std::string extension() const;
};

/// The format that the file's extension (in any case) stands for, if it is one of `possible`.
/// @throws ClientError kUsage naming the possible extensions.
FileFormat choose_format(const std::filesystem::path& file, std::span<const FileFormat> possible,
                         const std::string& what);

/// The same for a destination: its format, if it names one, else what its file's extension stands for.  The
/// standard output needs a format, unless there is but one.
FileFormat choose_format(const Destination& destination, std::span<const FileFormat> possible,
                         const std::string& what);

}  // namespace affskel::client
