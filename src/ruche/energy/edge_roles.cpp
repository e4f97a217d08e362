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

    void visit(const Edge& edge, bool may_hinge) {
        const bool inner = !edge.on_boundary();
        const bool printed0 = printed(edge, 0);
        const bool printed1 = inner && printed(edge, 1);
        if (inner && !(printed0 && printed1) && may_hinge) add_hinge(edge);
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
        roles_.hinges.push_back({{edge.vertex[0], edge.vertex[1], opposite(edge, 0), opposite(edge, 1)},
                                 hinge_stiffness(input_, edge)});
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

double hinge_stiffness(const ModelInput& input, const Edge& edge) {
    const bool plate = input.options.bending_normalisation == BendingNormalisation::plate;
    const double stiffness = input.material.fabric_bending_stiffness * (plate ? 1.0 : 6.0);
    const Mat2 relax = relaxation(input);
    const Vec2 along = input.mesh.vertices[edge.vertex[1]] - input.mesh.vertices[edge.vertex[0]];
    const double area = layout_area(input.mesh, edge.triangle[0]) + layout_area(input.mesh, edge.triangle[1]);
    return stiffness * (relax * along).squaredNorm() / (area * relax.determinant());
}

std::vector<Ply> plies(const ModelInput& input, const Print& print, const Mat2& layout_metric,
                       const Mat2& fabric_metric) {
    const Material& m = input.material;
    // The paper's eq. 8, read literally, has the coefficients of layers half as thick.
    const double scale = input.options.laminate_thickness == LaminateThickness::as_printed ? 0.5 : 1.0;
    return printed_plies(
        {.front = scale * print.front,
         .back = scale * print.back,
         .fabric = scale * m.fabric_thickness,
         .front_modulus = print.front_modulus > 0.0 ? print.front_modulus : m.plastic_youngs_modulus,
         .back_modulus = print.back_modulus > 0.0 ? print.back_modulus : m.plastic_youngs_modulus,
         .fabric_modulus = m.fabric_youngs_modulus},
        layout_metric, fabric_metric);
}

EdgeRoles edge_roles(const ModelInput& input, const MeshEdges& edges, const std::vector<char>& no_hinge) {
    RoleFinder finder(input);
    for (std::size_t e = 0; e < edges.edges.size(); ++e)
        finder.visit(edges.edges[e], no_hinge.empty() || no_hinge[e] == 0);
    return std::move(finder).roles();
}

}  // namespace ruche
