#include "core/files/vtk_arrays.h"

#include <gtest/gtest.h>

namespace affskel::core {
namespace {

using Names = std::vector<std::string>;

TEST(VtkArrays, ColumnsAndArraysAreNamedAfterEachOther) {
  EXPECT_EQ(columns_of_array("E", 1), Names{"E"});
  for (const auto& [array, columns] :
       std::vector<std::pair<std::string, Names>>{{"normal", {"nx", "ny", "nz"}},
                                                  {"normal_a", {"nx_a", "ny_a", "nz_a"}},
                                                  {"Normals", {"Normals_x", "Normals_y", "Normals_z"}},
                                                  {"normals", {"normals_x", "normals_y", "normals_z"}},
                                                  {"nx_", {"nx__x", "nx__y", "nx__z"}}}) {
    EXPECT_EQ(columns_of_array(array, 3), columns);
    EXPECT_EQ(array_of_columns(columns[0], columns[1], columns[2]), array);
  }
  EXPECT_EQ(columns_of_array("uv", 2), (Names{"uv_0", "uv_1"}));
}

TEST(VtkArrays, OtherColumnsAreNoArray) {
  EXPECT_EQ(array_of_columns("nx", "nz", "ny"), "");
  EXPECT_EQ(array_of_columns("nx_a", "ny_a", "nz_b"), "");
  EXPECT_EQ(array_of_columns("E", "H", "direction"), "");
  EXPECT_EQ(array_of_columns("_x", "_y", "_z"), "");
  // They would read back as nx, ny, nz.
  EXPECT_EQ(array_of_columns("normal_x", "normal_y", "normal_z"), "");
}

}  // namespace
}  // namespace affskel::core
