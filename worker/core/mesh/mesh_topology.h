#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/mesh/mesh.h"

namespace affskel::core {

/// Half-edge h = 3 t + i runs from corner i to corner i + 1 (mod 3) of triangle t.
using HalfEdges = std::vector<std::uint32_t>;

/// Which triangle of the input a message is about, for people: "triangle 17 (line 271)".
using TrianglePlace = std::function<std::string(std::uint32_t triangle)>;

/// Which edge of the input, for people, by one of its half-edges: "vertices 3 and 7".
using EdgePlace = std::function<std::string(std::uint32_t half_edge)>;

/// The half-edge on the other side of every half-edge, whatever way it runs.
/// @throws CoreError kBadInput at the first edge with one triangle (a hole), with more than two, or with
///   the same triangle twice; the message counts them and names the first place.
HalfEdges find_mates(const Mesh& mesh, const TrianglePlace& place, const EdgePlace& edge);

/// The same into `mates`, without an error: false when some edge does not have two different triangles.  On
/// up to `threads` threads.
bool find_mates_if_closed(const Mesh& mesh, unsigned threads, HalfEdges& mates);

/// Whether every edge has two triangles or more; cheaper than find_mates and without an error.
bool every_edge_is_shared(const Mesh& mesh);

/// Turns triangles over until neighbours agree (their common edge runs both ways); in each connected
/// surface the fewer ones are turned.  Keeps `mates` valid.  Returns the turned triangles, ascending.
/// @throws CoreError kBadInput when a surface has one side only (not orientable).
std::vector<std::uint32_t> orient_consistently(Mesh& mesh, HalfEdges& mates, const TrianglePlace& place);

/// Gives every fan of triangles round a vertex a vertex of its own, so that the neighbourhood of every
/// vertex is a disc.  Requires consistent orientation.  Returns the number of vertices added (at the end).
std::uint32_t split_pinched_vertices(Mesh& mesh, const HalfEdges& mates);

/// The connected surface each triangle belongs to, numbered by first triangle; their number.
std::vector<std::uint32_t> connected_surfaces(const HalfEdges& mates, std::uint32_t& count);

}  // namespace affskel::core
