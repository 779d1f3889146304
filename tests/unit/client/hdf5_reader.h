#pragma once

#include <gtest/gtest.h>
#include <hdf5.h>

#include <string>
#include <vector>

namespace affskel::client {

// What the exporters wrote, read back with the HDF5 library itself.

/// All values of an attribute, which must have `size`.
template <typename T>
std::vector<T> read_attribute(hid_t group, const char* name, hid_t type, std::size_t size) {
  std::vector<T> values(size);
  const hid_t attribute = H5Aopen(group, name, H5P_DEFAULT);
  EXPECT_GE(attribute, 0) << name;
  const hid_t space = H5Aget_space(attribute);
  EXPECT_EQ(H5Sget_simple_extent_npoints(space), static_cast<hssize_t>(size)) << name;
  EXPECT_GE(H5Aread(attribute, type, values.data()), 0) << name;
  H5Sclose(space);
  H5Aclose(attribute);
  return values;
}

/// A PointData array, which must have the dimensions z, y, x and those of its components.
template <typename T>
std::vector<T> read_array(hid_t file, const std::string& name, hid_t type, const std::vector<hsize_t>& dims) {
  const hid_t dataset = H5Dopen2(file, ("/VTKHDF/PointData/" + name).c_str(), H5P_DEFAULT);
  EXPECT_GE(dataset, 0) << name;
  const hid_t space = H5Dget_space(dataset);
  std::vector<hsize_t> found(static_cast<std::size_t>(H5Sget_simple_extent_ndims(space)));
  H5Sget_simple_extent_dims(space, found.data(), nullptr);
  EXPECT_EQ(found, dims) << name;
  std::size_t size = 1;
  for (const hsize_t d : found) size *= d;
  std::vector<T> values(size);
  EXPECT_GE(H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), 0) << name;
  H5Sclose(space);
  H5Dclose(dataset);
  return values;
}

}  // namespace affskel::client
