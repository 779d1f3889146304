#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "base/atomic_file.h"
#include "core/files/file_facts.h"
#include "core/files/grid_file.h"
#include "core/lattice/lattice.h"

namespace affskel::core {

/// A VTK XML file of ImageData (.vti) or, with a point for every place, of a StructuredGrid (.vts): inline
/// base64, compressed by zlib, which every ParaView and VTK since 2013 reads.  Large grids are written as
/// several pieces that share a plane.  Facts become field data: arrays of one number or one string.
/// @param points whether it is a StructuredGrid.
/// @param file, grid must outlive it.
/// @param piece_places places of a piece, about; at least two planes make one.
/// @throws std::logic_error for an image of a grid that is not upright; base::FileError, also from the file.
std::unique_ptr<GridFile> make_vtk_xml_grid(base::AtomicFile& file, const LatticeGrid& grid, bool points,
                                            std::vector<GridArray> arrays, const FileFacts& facts,
                                            std::uint64_t piece_places = std::uint64_t{1} << 19);

}  // namespace affskel::core
