#pragma once

#include "core/files/shape_file.h"

namespace affskel::client {

// The shapes of files, which client and worker share.
using core::PointColumn;
using core::shape_of;
using core::ShapeFile;

}  // namespace affskel::client
