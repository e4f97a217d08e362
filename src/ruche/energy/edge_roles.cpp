#include "ruche/energy/edge_roles.hpp"

#include <cmath>
#include <numbers>

namespace ruche {
namespace {

using EdgeSide = LaminateTerm::EdgeSide;

class RoleFinder {
  public:
    explicit RoleFinder(const ModelInput& input)
        : input_(input), free_(input.options.edge_normals == EdgeNormals::free) {
        roles_.sides.resize(input.mesh.triangles.size());
    }

    void visit(const Edge& edge) {
        const bool inner = !edge.on_boundary();
        const bool printed0 = printed(edge, 0);
        const bool printed1 = inner && printed(edge, 1);
        if (inner && !(printed0 && printed1)) add_hinge(edge);
        if (printed0 && printed1) {
            add_common_normal(edge, free_);
        } else if (inner && !free_) {
            add_common_normal(edge, false);
        } else if (printed0 || printed1) {
            add_rim(edge, printed0 ? 0 : 1);
        }
    }

    EdgeRoles roles() && { return std::move(roles_); }

  private:
    const TriangleMesh& mesh() const { return input_.mesh; }
    bool printed(const Edge& edge, int side) const { return !input_.print[edge.triangle[side]].bare(); }
    int opposite(const Edge& edge, int side) const {
        return mesh().triangles[edge.triangle[side]][edge.local[side]];
    }
    Vec2 along(const Edge& edge) const {
        return mesh().vertices[edge.vertex[1]] - mesh().vertices[edge.vertex[0]];
    }
    double area(const Edge& edge) const {
        return layout_area(mesh(), edge.triangle[0]) + layout_area(mesh(), edge.triangle[1]);
    }
    EdgeSide& side_of(const Edge& edge, int side) {
        return roles_.sides[edge.triangle[side]][edge.local[side]];
    }
    int new_unknown(const Edge& edge, int opposite0, int opposite1) {
        roles_.unknowns.push_back({edge.vertex[0], edge.vertex[1], opposite0, opposite1});
        return mesh().vertex_count() + static_cast<int>(roles_.unknowns.size()) - 1;
    }

    void add_hinge(const Edge& edge) {
        const bool plate = input_.options.bending_normalisation == BendingNormalisation::plate;
        const double stiffness = input_.material.fabric_bending_stiffness * (plate ? 1.0 : 6.0);
        const Mat2 relax = relaxation(input_);
        const double rest_length2 = (relax * along(edge)).squaredNorm();
        const double rest_area = area(edge) * relax.determinant();
        roles_.hinges.push_back({{edge.vertex[0], edge.vertex[1], opposite(edge, 0), opposite(edge, 1)},
                                 stiffness * rest_length2 / rest_area});
    }

    /// The normal of the edge is one for both of its triangles; it may turn about the edge, or is their mean.
    void add_common_normal(const Edge& edge, bool turns) {
        const int node = turns ? new_unknown(edge, opposite(edge, 0), opposite(edge, 1)) : -1;
        for (int side = 0; side < 2; ++side) {
            if (!printed(edge, side)) continue;
            side_of(edge, side) = {.kind = EdgeSide::Kind::hinged,
                                   .flap = opposite(edge, 1 - side),
                                   .unknown = node,
                                   .sign = side == 0 ? 1.0 : -1.0,
                                   .mean_altitude = area(edge) / along(edge).norm()};
        }
    }

    void add_rim(const Edge& edge, int side) {
        EdgeSide& rim = side_of(edge, side);
        if (!free_) {
            rim.kind = EdgeSide::Kind::clamped_rim;
        } else if (input_.options.fabric_ply == FabricPlyLaw::linear) {
            rim.kind = EdgeSide::Kind::free_rim;
        } else {
            rim.kind = EdgeSide::Kind::open_rim;
            rim.unknown = new_unknown(edge, opposite(edge, side), opposite(edge, side));
        }
    }

    const ModelInput& input_;
    bool free_;
    EdgeRoles roles_;
};

}  // namespace

Mat2 relaxation(const ModelInput& input) {
    const double phi = input.fabric_axis_deg * std::numbers::pi / 180.0;
    Mat2 to_fabric_axes;
    to_fabric_axes << std::cos(phi), std::sin(phi), -std::sin(phi), std::cos(phi);
    return Vec2(1.0 / input.prestretch[0], 1.0 / input.prestretch[1]).asDiagonal() * to_fabric_axes;
}

EdgeRoles edge_roles(const ModelInput& input, const MeshEdges& edges) {
    RoleFinder finder(input);
    for (const Edge& edge : edges.edges) finder.visit(edge);
    return std::move(finder).roles();
}

}  // namespace ruche
