#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace affskel::core {

/// Columns hold single numbers, arrays of VTK several per point.  The columns of an array: "normal" of three
/// is nx, ny, nz; "normal_a" is nx_a, ny_a, nz_a; any other of three, "v", is v_x, v_y, v_z; of another
/// number, v_0, v_1, ...; of one, v itself.
std::vector<std::string> columns_of_array(const std::string& array, std::size_t components);

/// The array whose columns these three are; empty when they are of none.
std::string array_of_columns(const std::string& x, const std::string& y, const std::string& z);

}  // namespace affskel::core
