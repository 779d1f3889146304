#include "client/operations/archive.h"

#include <zip.h>

#include <memory>
#include <set>

#include "client/base/error.h"
#include "client/operations/fetch.h"
#include "client/text/portable_name.h"

namespace affskel::client {
namespace {

namespace fs = std::filesystem;

constexpr zip_uint32_t kFast = 1;  // the fields are compressed already

[[noreturn]] void cannot_write(const fs::path& file, const std::string& why) {
  throw ClientError(ExitCode::kLimit, "cannot write the archive " + file.filename().string() + ": " + why);
}

class Archive {
 public:
  explicit Archive(fs::path file) : file_(std::move(file)) {
    int code = 0;
    zip_.reset(zip_open(file_.c_str(), ZIP_CREATE | ZIP_EXCL, &code));
    if (zip_) return;
    zip_error_t error;
    zip_error_init_with_code(&error, code);
    const std::string why = zip_error_strerror(&error);
    zip_error_fini(&error);
    cannot_write(file_, why);
  }

  // The file is read when all is written.
  void add(const fs::path& source, const std::string& name, std::uint64_t changed_ms) {
    zip_source_t* from = zip_source_file(zip_.get(), source.c_str(), 0, -1);
    if (from == nullptr) cannot_write(file_, zip_strerror(zip_.get()));
    const zip_int64_t entry = zip_file_add(zip_.get(), name.c_str(), from, ZIP_FL_ENC_UTF_8);
    if (entry < 0) {
      zip_source_free(from);
      cannot_write(file_, zip_strerror(zip_.get()));
    }
    const auto index = static_cast<zip_uint64_t>(entry);
    zip_set_file_compression(zip_.get(), index, ZIP_CM_DEFLATE, kFast);
    zip_file_set_mtime(zip_.get(), index, static_cast<time_t>(changed_ms / 1000), 0);
  }

  void write() {
    if (zip_close(zip_.get()) != 0) cannot_write(file_, zip_strerror(zip_.get()));
    zip_.release();
  }

 private:
  struct Discard {
    void operator()(zip_t* zip) const { zip_discard(zip); }
  };
  fs::path file_;
  std::unique_ptr<zip_t, Discard> zip_;
};

// Names of jobs need not differ; those of folders do.
std::string folder_of(const v1::Job& job, std::set<std::string>& taken) {
  const std::string stem = portable_name(job.name());
  std::string folder = stem;
  for (int n = 2; !taken.insert(folder).second; ++n) folder = stem + "-" + std::to_string(n);
  return folder;
}

class Scratch {
 public:
  explicit Scratch(fs::path path) : path_(std::move(path)) { fs::create_directory(path_); }
  ~Scratch() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

}  // namespace

void write_archive(Session& session, const std::vector<v1::Job>& jobs, const fs::path& file) {
  if (jobs.size() > kMaxArchived)
    throw ClientError(ExitCode::kLimit, "an archive holds " + std::to_string(kMaxArchived) + " jobs at most");
  const Scratch scratch(fs::path(file).concat(".parts"));
  Archive archive(file);
  std::set<std::string> taken;
  for (const v1::Job& job : jobs) {
    const std::string folder = folder_of(job, taken);
    const fs::path there = scratch.path() / job.id();
    fs::create_directory(there);
    std::vector<FetchRequest> wanted = main_files(job, (there / portable_name(job.name())).string());
    wanted.push_back(one_file(job, "mesh", there / (portable_name(job.name()) + ".off")));
    for (const FetchRequest& request : wanted) {
      fetch(session, request);
      const fs::path& part = request.destination.file;
      archive.add(part, folder + "/" + part.filename().string(), job.finished_ms());
    }
  }
  archive.write();
}

}  // namespace affskel::client
