#include "limit.h"

#include <cstdio>
#include <exception>
#include <fstream>

#include "measure.h"

namespace affskel::bench {
namespace {

// make_sphere() goes no further.
constexpr std::uint32_t kMaxTriangles = std::uint32_t{1} << 26;
constexpr std::uint64_t kMaxPoints = std::uint64_t{1} << 31;

RowSpec job_of(std::uint32_t triangles, std::uint64_t points) {
  RowSpec row;
  row.section = Section::kMemory;
  row.mesh = {Shape::kBall, triangles};
  row.points = points;
  row.directions = "sphere:20";
  return row;
}

RowResult try_job(const RowSpec& row, MeshStore& meshes, const LimitOptions& options) {
  RowResult result;
  try {
    result = measure(row, meshes.file(row.mesh), {.two_threads = false, .memory_limit = options.memory});
  } catch (const std::exception& error) {  // the mesh could not be made
    result.name = row_name(row);
    result.section = row.section;
    result.error = error.what();
  }
  result.source = meshes.source(row.mesh);
  return result;
}

// Tries rows until one ends the search; says whether to go on.
bool try_next(const RowSpec& row, MeshStore& meshes, const LimitOptions& options, LimitSearch& search) {
  const RowResult& result = search.results.emplace_back(try_job(row, meshes, options));
  options.done(result);
  if (!result.error.empty()) {
    search.reason = result.error;
  } else if (result.wall_s > options.longest_s) {
    search.reason = "the time allowed for one job";
  }
  return search.reason.empty();
}

double fixed_mb(const LimitSearch& search) {
  return search.results.empty() ? 0 : search.results.front().peak_mb;
}

std::string result_line(const LimitSearch& search, const RowResult& r) {
  if (!r.error.empty()) return "| " + r.name + " | failed: " + r.error + " | | | | |\n";
  // Between this job and the first: what another triangle or point costs.
  const double units = static_cast<double>(r.triangles + r.points) -
                       static_cast<double>(search.results.front().triangles + search.results.front().points);
  char text[192];
  std::snprintf(text, sizeof text, " | %llu | %llu | %.1f | %.0f | ",
                static_cast<unsigned long long>(r.triangles), static_cast<unsigned long long>(r.points),
                r.wall_s, r.peak_mb);
  std::string line = "| " + r.name + text;
  if (units > 0) {
    std::snprintf(text, sizeof text, "%.0f", (r.peak_mb - fixed_mb(search)) * (1 << 20) / units);
    line += text;
  }
  return line + " |\n";
}

}  // namespace

std::vector<LimitSearch> find_limits(MeshStore& meshes, const LimitOptions& options) {
  std::vector<LimitSearch> searches(2);
  searches[0].what = "triangles N";
  for (std::uint32_t n = options.first_triangles;; n *= 2) {
    if (n > kMaxTriangles) {
      searches[0].reason = "the generator's limit";
      break;
    }
    if (!try_next(job_of(n, 100000), meshes, options, searches[0])) break;
  }
  searches[1].what = "points R";
  for (std::uint64_t r = options.first_points;; r *= 2) {
    if (r > kMaxPoints) {
      searches[1].reason = "the lattice's limit";
      break;
    }
    if (!try_next(job_of(5120, r), meshes, options, searches[1])) break;
  }
  return searches;
}

std::uint64_t available_memory() {
  std::ifstream info("/proc/meminfo");
  for (std::string word; info >> word;) {
    std::uint64_t kibibytes = 0;
    if (word == "MemAvailable:" && info >> kibibytes) return kibibytes << 10;
  }
  return 0;
}

std::string limits_markdown(const std::vector<LimitSearch>& searches, const LimitOptions& options) {
  char text_of_options[96];
  std::snprintf(text_of_options, sizeof text_of_options, "Jobs may use %.1f GB and %.0f s.\n",
                static_cast<double>(options.memory) / (1 << 30), options.longest_s);
  std::string text = text_of_options;
  for (const LimitSearch& search : searches) {
    text += "\n### Doubling the " + search.what +
            "\n\n| row | N | R | wall s | peak MB | bytes per further triangle or point |\n"
            "|---|--:|--:|--:|--:|--:|\n";
    for (const RowResult& result : search.results) text += result_line(search, result);
    text += "\nEnded by: " + search.reason + ".\n";
  }
  return text;
}

}  // namespace affskel::bench
