#pragma once

#include <grpcpp/client_context.h>

#include "affskel/v1/client_service.grpc.pb.h"
#include "client/connection/session.h"

namespace affskel::client {

// One attempt each of the calls that stream.

/// Fetches an artefact into a sink.
/// @throws ClientError kInternal when its parts come out of order, or its size or SHA-256 is another; what
/// the sink throws.
grpc::Status fetch_once(v1::ErosionService::Stub& stub, grpc::ClientContext& context,
                        const v1::FetchArtifactRequest& request, ArtifactSink& sink,
                        v1::ArtifactHeader& header);

/// Submits a mesh; sets the context's deadline by the size of all that is sent.
grpc::Status submit_once(v1::ErosionService::Stub& stub, grpc::ClientContext& context,
                         const v1::SubmitJobHeader& header, const GivenMeshes& meshes,
                         v1::SubmitJobResponse& response);

}  // namespace affskel::client
