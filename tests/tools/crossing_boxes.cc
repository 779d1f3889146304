#include "tools/crossing_boxes.h"

#include <array>
#include <random>
#include <sstream>

namespace affskel::tests {

std::string crossing_boxes(int count) {
  std::mt19937_64 random(1);
  const auto half_side = [&] { return 1000000 + static_cast<int>(random() % 1000000); };
  std::ostringstream text;
  text << "OFF\n" << 8 * count << ' ' << 6 * count << " 0\n";
  for (int i = 0; i < count; ++i) {
    std::array<std::array<int, 2>, 3> side{};  // least and greatest x, y, z
    for (std::array<int, 2>& s : side) s = {-half_side(), half_side()};
    for (std::size_t corner = 0; corner < 8; ++corner)
      text << side[0][corner & 1] << ' ' << side[1][corner >> 1 & 1] << ' ' << side[2][corner >> 2] << '\n';
  }
  for (int i = 0; i < count; ++i) {
    for (const std::array<int, 4>& face : {std::array<int, 4>{0, 2, 3, 1},
                                           {4, 5, 7, 6},
                                           {0, 1, 5, 4},
                                           {2, 6, 7, 3},
                                           {0, 4, 6, 2},
                                           {1, 3, 7, 5}}) {
      text << 4;
      for (const int corner : face) text << ' ' << 8 * i + corner;
      text << '\n';
    }
  }
  return text.str();
}

}  // namespace affskel::tests
