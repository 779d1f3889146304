#pragma once

#include <memory>
#include <vector>

#include "base/atomic_file.h"
#include "core/files/file_facts.h"
#include "core/files/grid_file.h"
#include "core/lattice/lattice.h"

namespace affskel::core {

/// A VTKHDF file of ImageData (version 1.0): places by WholeExtent, Origin, Spacing and Direction (and
/// `frame_axes` where the lattice is not parallel to the mesh's axes), PointData datasets with dimensions in
/// the order z, y, x.  Facts become attributes of the group VTKHDF.
/// @param file must outlive it.
/// @throws base::FileError naming the file, also from the grid; CoreError kInternal for what else HDF5
/// refuses.
std::unique_ptr<GridFile> make_vtkhdf_grid(base::AtomicFile& file, const LatticeGrid& grid,
                                           std::vector<GridArray> arrays, const FileFacts& facts);

}  // namespace affskel::core
