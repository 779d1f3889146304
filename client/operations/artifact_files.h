#pragma once

#include "client/operations/fetch.h"

namespace affskel::client {

// Each fetches the artefact of its name for fetch(), and writes it.

// Values at the sample points, in the order of the lattice; they pass through without being kept.
Fetched fetch_field(Session& session, const FetchRequest& request);
Fetched fetch_divergence(Session& session, const FetchRequest& request);

// Points and surfaces, which are small enough to be kept.
Fetched fetch_skeleton(Session& session, const FetchRequest& request);
Fetched fetch_surface(Session& session, const FetchRequest& request);
/// The lines of operator `curve`.
Fetched fetch_curve(Session& session, const FetchRequest& request);
/// The solid's surface with its thickness and part per triangle.
Fetched fetch_thickness(Session& session, const FetchRequest& request);
Fetched fetch_eroded(Session& session, const FetchRequest& request);
/// As OFF the submitted bytes, also without an extension; in the other surface_formats the same surface,
/// facing outward.
Fetched fetch_submitted_mesh(Session& session, const FetchRequest& request);
Fetched fetch_source_mesh(Session& session, const FetchRequest& request);

}  // namespace affskel::client
