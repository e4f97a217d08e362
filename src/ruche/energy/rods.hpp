#pragma once

#include <array>
#include <vector>

#include "ruche/energy/model.hpp"
#include "ruche/energy/rod_edge.hpp"
#include "ruche/energy/rod_joint.hpp"

namespace ruche {

/// The rods of a model as elements of the energy.
struct RodElements {
    std::vector<RodEdge::Element> edges;
    std::vector<RodJoint::Element> joints;
    std::vector<std::array<int, 4>> unknowns;  ///< per edge of a rod: its ends, corners to its left and right
    std::vector<char> on_rod;                  ///< per edge of the mesh
};

/// Throws InputError for a rod that is no line of inner edges or has no section, and when rods or printed
/// triangles are not what ModelOptions::strips says. The first edge of the first rod has the edge unknown
/// with the node number of the mesh's vertex count.
RodElements rod_elements(const ModelInput& input, const MeshEdges& edges);

/// What a rod in a direction of the layout (a unit vector) would be bent by without load, per length (1/mm):
/// twist, curvature about n x t, curvature about n. It is that of a free narrow strip of the laminate.
Vec3 natural_curvature(const ModelInput& input, const Rod& rod, const Vec2& direction);

}  // namespace ruche
