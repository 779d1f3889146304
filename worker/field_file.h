#pragma once

#include <string>

#include "core/erosion/directions.h"
#include "core/erosion/field.h"
#include "core/lattice/lattice.h"
#include "core/solid/solid.h"

namespace affskel::worker {

/// @throws core::CoreError kBadInput unless the path ends in .csv or .dat.
void check_field_file(const std::string& path);

/// Writes a field as .csv (header, then x,y,z,E,nx,ny,nz,direction) or .dat (x y z E nx ny nz), in mesh
/// units, 17 significant digits, in lattice order.  The file appears complete or not at all, see
/// base::AtomicFile.
/// @throws base::FileError naming the path; nothing is left behind then.
void write_field_file(const std::string& path, const core::Solid& solid, const core::Lattice& lattice,
                      const core::DirectionSet& directions, const core::ErosionField& field);

}  // namespace affskel::worker
