#include "client/files/format.h"

#include <array>
#include <vector>

#include "base/lower_case.h"
#include "client/base/error.h"

namespace affskel::client {
namespace {

constexpr std::array kPicture = {FileFormat::kPng};
constexpr std::array kThickness = {FileFormat::kPly, FileFormat::kVtp};
constexpr std::array kSkeleton = {FileFormat::kVtp, FileFormat::kPly, FileFormat::kObj, FileFormat::kStl,
                                  FileFormat::kOff, FileFormat::kCsv, FileFormat::kXyz};
constexpr std::array kPage = {FileFormat::kHtml};

}  // namespace

std::span<const FileFormat> divergence_formats() {
  return field_formats();
}

std::span<const FileFormat> parted_field_formats() {
  static const std::vector<FileFormat> formats = [] {
    std::vector<FileFormat> all(field_formats().begin(), field_formats().end());
    std::erase(all, FileFormat::kDat);
    return all;
  }();
  return formats;
}

std::span<const FileFormat> thickness_formats() {
  return kThickness;
}

std::span<const FileFormat> curve_file_formats() {
  static const std::vector<FileFormat> formats = [] {
    const auto of_lines = core::curve_formats();
    std::vector<FileFormat> all(of_lines.begin(), of_lines.end());
    all.insert(all.end(), {FileFormat::kCsv, FileFormat::kXyz});
    return all;
  }();
  return formats;
}

std::span<const FileFormat> skeleton_file_formats() {
  return kSkeleton;
}

std::span<const FileFormat> picture_formats() {
  return kPicture;
}

std::span<const FileFormat> page_formats() {
  return kPage;
}

std::string lower_extension(const std::filesystem::path& file) {
  return base::lower_case(file.extension().string());
}

std::string Destination::extension() const {
  if (format.empty()) return is_stdout() ? std::string() : lower_extension(file);
  return base::lower_case(format.starts_with('.') ? format : "." + format);
}

FileFormat choose_format(const Destination& destination, std::span<const FileFormat> possible,
                         const std::string& what) {
  const std::string extension = destination.extension();
  if (extension.empty() && destination.is_stdout() && possible.size() == 1) return possible.front();
  std::string names;
  for (const FileFormat format : possible) {
    if (extension == extension_of(format)) return format;
    names += (names.empty() ? "" : ", ") + std::string(extension_of(format));
  }
  std::string refused = "cannot write the " + what + " as '" + extension + "'";
  if (extension.empty()) refused = "has no extension to tell how to write the " + what;
  std::error_code unknown;
  const bool folder =
      !destination.file.has_filename() || std::filesystem::is_directory(destination.file, unknown);
  if (destination.format.empty() && !destination.is_stdout() && folder)
    refused = "is a folder; name a file in it for the " + what;
  if (extension.empty() && destination.is_stdout()) refused = "a format is needed for the " + what;
  throw ClientError(ExitCode::kUsage, refused + "; possible are " + names, destination.name());
}

FileFormat choose_format(const std::filesystem::path& file, std::span<const FileFormat> possible,
                         const std::string& what) {
  if (file == "-") return choose_format(Destination{"./-"}, possible, what);
  return choose_format(Destination{file}, possible, what);
}

}  // namespace affskel::client
