#pragma once

#include <cstdint>
#include <vector>

#include "ruche/geometry/triangle_mesh.hpp"
#include "ruche/meshing/print_mesh.hpp"

namespace ruche {

/// How a rectangle is divided, for studies of what the mesh itself does to a result.
enum class MeshKind {
    lattice,      ///< rows of nearly equilateral triangles
    alternating,  ///< squares cut by diagonals whose direction alternates like a chessboard's colours
    criss_cross,  ///< squares cut by both diagonals
    jittered      ///< alternating, with every vertex moved; those on the border along it, corners not
};

struct RectangleOptions {
    double length = 30.0;    ///< mm, along x from 0
    double width = 1.0;      ///< mm, along y from 0
    int across = 1;          ///< rows of elements
    double jitter = 0.3;     ///< largest displacement over the element size, below 0.35
    std::uint64_t seed = 1;  ///< of the displacements
};

/// Throws InputError for sizes that are not positive.
TriangleMesh rectangle_mesh(MeshKind kind, const RectangleOptions& options);

/// `count` >= 2 evenly spaced points of a line, on the mesh; points off the mesh are left out.
std::vector<MeshPoint> points_on_mesh(const TriangleMesh& mesh, const Polyline& line, int count);

}  // namespace ruche
