#include "core/curve/parted_lines.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/median.h"
#include "core/base/none.h"
#include "core/base/symmetric_eigen.h"
#include "core/mesh/polylines.h"

namespace affskel::core {
namespace {

constexpr double kSudden = 0.4;  // of the way along a line: what a limb's radius grows by where it ends
constexpr double kPlate = 2;     // times as wide as thick: what is nearest to a line makes no tube

class PartLines {
 public:
  explicit PartLines(const PartedLinesInput& input)
      : in_(input),
        ends_(ends_of(input.places.size(), input.lines)),
        result_{{},
                std::vector<std::uint32_t>(input.places.size(), kNone),
                std::vector<char>(input.places.size(), 0),
                DisjointSets(input.places.size())} {}

  PartedLines run() {
    for (const auto& line : in_.lines) part(line);
    return std::move(result_);
  }

 private:
  bool is_joint(std::uint32_t v) const { return ends_[v] > 2; }

  // How thick a line is in the middle of its vertices.
  double size_of(const std::vector<std::uint32_t>& line) const {
    std::vector<double> radii;
    for (const std::uint32_t v : line)
      if (!is_joint(v)) radii.push_back(in_.radius[v]);
    return radii.empty() ? 0 : median(std::move(radii));
  }

  // How much wider than thick what is nearest to a line is, across it: in the middle one of its slices, which are thinner than
  // both.  At its ends these may hold much of what it hangs on.
  double flatness(std::span<const std::uint32_t> line) const {
    std::vector<double> found;
    for (const std::uint32_t v : line) {
      const double count = in_.moments[v].count;
      if (is_joint(v) || count == 0) continue;
      const auto spread =
          symmetric_eigen(in_.moments[v].about_centre() + count * square_in_cell(in_.spacing) * kIdentity3)
              .values;
      found.push_back(std::sqrt(spread[0] / spread[1]));
    }
    return found.empty() ? 1 : median(std::move(found));
  }

  // How many of a line's first vertices are no limb's; from its middle on, by what it grows over a radius.
  std::size_t before_limb(std::span<const std::uint32_t> line) const {
    for (std::size_t n = line.size() / 2; n > 1; --n)
      if (grows_at(in_.places, line, n - 1, in_.radius)) return n;
    return 1;
  }

  void part(std::vector<std::uint32_t> line) {
    const std::uint32_t a = line.front(), b = line.back();
    const double length = length_of(in_.places, line);
    const double size = size_of(line);
    const bool is_link = is_joint(a) && is_joint(b);
    if (is_link && (length < 2 * size || (a != b && flatness(line) > kPlate)))
      return give_body(line, line.size());
    for (const std::uint32_t v : line)
      if (!is_joint(v)) result_.limb[v] = static_cast<std::uint32_t>(result_.limbs.size());
    result_.limbs.push_back({line, size, length});
    for (int end = 0; end < 2; ++end, std::reverse(line.begin(), line.end()))
      if (is_joint(line[0])) give_body(line, before_limb(line));
  }

  void give_body(const std::vector<std::uint32_t>& line, std::size_t count) {
    for (std::size_t n = 0; n < count; ++n) {
      result_.is_body[line[n]] = 1;
      result_.bodies.unite(line[n], line[0]);
    }
  }

  const PartedLinesInput& in_;
  std::vector<std::uint32_t> ends_;  // of lines, per vertex
  PartedLines result_;
};

}  // namespace

PartedLines parted_lines(const PartedLinesInput& input) {
  return PartLines(input).run();
}

bool grows_at(std::span<const Vec3> places, std::span<const std::uint32_t> line, std::size_t n,
              std::span<const double> size) {
  double length = 0;
  std::size_t k = n;
  for (; k < line.size() / 2 && length < size[line[k]]; ++k)
    length += norm(places[line[k]] - places[line[k + 1]]);
  return size[line[n]] - size[line[k]] > kSudden * length;
}

}  // namespace affskel::core
