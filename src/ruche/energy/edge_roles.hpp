#pragma once

#include <array>
#include <vector>

#include "ruche/energy/fabric_bending.hpp"
#include "ruche/energy/laminate_term.hpp"
#include "ruche/energy/model.hpp"

namespace ruche {

/// Maps the layout on the frame to the relaxed fabric in fabric axes.
Mat2 relaxation(const ModelInput& input);

/// What each edge of the mesh is to the terms of the energy, as the model's options have it: hinges, the edge
/// sides of printed triangles, and the edge unknowns.
struct EdgeRoles {
    std::vector<FabricBending::Hinge> hinges;
    std::vector<std::array<LaminateTerm::EdgeSide, 3>> sides;  ///< per triangle
    /// Per edge unknown: its edge's ends and the two opposite vertices; on a rim, twice that of the printed
    /// triangle.
    std::vector<std::array<int, 4>> unknowns;
};
/// `no_hinge`: edges (by number) that have none; empty = none of them.
EdgeRoles edge_roles(const ModelInput& input, const MeshEdges& edges, const std::vector<char>& no_hinge);

/// k_B |e|^2 / A_e of an inner edge, mJ (see FabricBending).
double hinge_stiffness(const ModelInput& input, const Edge& edge);

/// The plies of a print for a basis of the layout in which layout and relaxed fabric have these metrics.
std::vector<Ply> plies(const ModelInput& input, const Print& print, const Mat2& layout_metric,
                       const Mat2& fabric_metric);

}  // namespace ruche
