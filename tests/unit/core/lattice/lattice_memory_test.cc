#include "core/lattice/lattice_memory.h"

#include <gtest/gtest.h>

#include <string>

#include "core/base/error.h"
#include "core/lattice/lattice.h"
#include "core/shapes/shapes.h"

namespace affskel::core {
namespace {

std::string refusal(const LatticeSize& size, double point_bytes, std::uint64_t budget) {
  try {
    require_lattice_memory(size, point_bytes, budget);
  } catch (const CoreError& error) {
    EXPECT_EQ(error.code(), CoreError::Code::kLimit);
    return error.what();
  }
  return {};
}

// The number after `words` in a message.
double number_after(const std::string& message, const std::string& words) {
  const std::size_t at = message.find(words);
  EXPECT_NE(at, std::string::npos) << message;
  return at == std::string::npos ? 0 : std::stod(message.substr(at + words.size()));
}

TEST(LatticeMemory, IsRefusedAboveTheBudgetOnly) {
  const LatticeSize size{1e6, 1e4, 10};
  const double need = lattice_memory(size, 20);
  EXPECT_EQ(refusal(size, 20, 0), "");
  EXPECT_EQ(refusal(size, 20, static_cast<std::uint64_t>(need)), "");
  EXPECT_NE(refusal(size, 20, static_cast<std::uint64_t>(need) - 1), "");
}

TEST(LatticeMemory, TheSpacingThatIsProposedFits) {
  for (const LatticeSize& size :
       {LatticeSize{3e8, 5e5, 7.2}, LatticeSize{1e6, 1e8, 0.01}, LatticeSize{0, 1e8, 3}}) {
    for (const double share : {0.9, 0.1, 1e-4}) {
      const double need = lattice_memory(size, 22);
      const auto budget = static_cast<std::uint64_t>(share * need);
      const double spacing = number_after(refusal(size, 22, budget), "at spacing ");
      EXPECT_NEAR(spacing, size.spacing, 0.01 * size.spacing) << "first what was asked for";
      const double proposed = number_after(refusal(size, 22, budget), "available; spacing ");
      const double times = proposed / size.spacing;
      const LatticeSize coarse{size.points / (times * times * times), size.lines / (times * times), proposed};
      EXPECT_LT(lattice_memory(coarse, 22), static_cast<double>(budget));
      EXPECT_GT(lattice_memory(coarse, 22), 0.7 * static_cast<double>(budget)) << "no coarser than needed";
    }
  }
}

TEST(MakeLattice, RefusesWhatDoesNotFitAndProposesWhatDoes) {
  const Solid solid = make_solid(make_sphere(3000, 1280));
  for (const bool by_spacing : {true, false}) {
    LatticeOptions options;
    if (by_spacing) {
      options.spacing = 100;
    } else {
      options.target_points = 110000;
    }
    options.point_bytes = 22;
    options.memory_budget = 1000000;
    std::string message;
    try {
      make_lattice(solid, options);
    } catch (const CoreError& error) {
      EXPECT_EQ(error.code(), CoreError::Code::kLimit);
      message = error.what();
    }
    EXPECT_NE(message.find("1 MB available"), std::string::npos) << message;
    options.target_points = 0;
    options.spacing = number_after(message, "available; spacing ");
    const Lattice fits = make_lattice(solid, options);
    EXPECT_NEAR(fits.points, number_after(message, "with about "), 0.1 * fits.points) << message;
  }
}

}  // namespace
}  // namespace affskel::core
