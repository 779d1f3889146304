#pragma once

#include <string>

#include "client/commands/shared/context.h"
#include "client/commands/shared/written.h"
#include "client/files/format.h"

namespace affskel::client {

/// Each fetches one artefact and writes it atomically.  `skeleton` null = the job's own
/// parameters.  The file is opened before the artefact is computed, so that a path which cannot be written
/// fails at once.
Written transfer_field(Context& context, const std::string& job, const Destination& destination);
Written transfer_skeleton(Context& context, const std::string& job, const v1::SkeletonParams* skeleton,
                          const Destination& destination);
Written transfer_surface(Context& context, const std::string& job, const v1::SurfaceParams& surface,
                         const Destination& destination);
Written transfer_divergence(Context& context, const std::string& job, const v1::SkeletonParams* skeleton,
                            const Destination& destination);
Written transfer_eroded_points(Context& context, const std::string& job, const v1::ErodedParams& params,
                               const Destination& destination);
Written transfer_eroded_surface(Context& context, const std::string& job, const v1::ErodedParams& params,
                                const Destination& destination);
/// As OFF the submitted bytes, also without an extension; in the other surface_formats the same surface.
Written transfer_mesh(Context& context, const std::string& job, const Destination& destination);

/// The format of a job's field that every ParaView and VTK opens in its place: .vti, or .vts where the
/// lattice is not parallel to the mesh's axes.
FileFormat open_field_format(const v1::Job& job);

/// Whether a file of this extension holds the surface of an eroded solid; else its points.
bool holds_eroded_surface(const Destination& destination);

}  // namespace affskel::client
