#pragma once

#include <vector>

#include "ruche/energy/term.hpp"

namespace ruche {

/// Bending and twisting of a rod between two of its edges:
///
///     W = sum_k B_k (kappa_k - rest_k)^2 / (2 l),   kappa = 2 tan(alpha / 2) u,   l = (L_0 + L_1) / 2
///
/// Each edge has a frame: t along it, n the mean of the normals of its two triangles turned about t by phi =
/// +-y / L, and m = n x t. u and alpha are axis and angle of the rotation that takes the first frame to the
/// second; u has the same components in both: kappa = (twist, bending about m, bending about n), each
/// integrated over l. This is the Kirchhoff rod of Bergou et al. (2008), whose kappa b has the size 2
/// tan(alpha / 2) too, without transported frames: the energy is a function of positions and angles alone,
/// infinite at alpha = pi.
class RodJoint {
  public:
    static constexpr std::string_view name = "rod_joint";
    static constexpr int vertex_slots = 7;
    static constexpr int edge_slots = 2;

    struct Element {
        std::array<int, 3> vertices;  ///< along the rod
        std::array<std::array<int, 2>, 2>
            corners;                    ///< per edge: opposite corners of the triangles left and right
        std::array<int, 2> unknowns;    ///< nodes of y
        std::array<double, 2> lengths;  ///< L, mm
        std::array<double, 2> signs;  ///< phi = sign y / L: -1 where an edge is passed against its rod's way
        Vec3 stiffness;               ///< B, N mm^2
        Vec3 rest = Vec3::Zero();     ///< kappa without stress
    };

    explicit RodJoint(std::vector<Element> elements) : elements_(std::move(elements)) {}

    int element_count() const { return static_cast<int>(elements_.size()); }
    std::array<int, 9> nodes(int element) const;
    Local<23> evaluate(int element, const Unknowns& x, Order order) const;

    /// kappa.
    Vec3 strain(int element, const Unknowns& x) const;

  private:
    std::vector<Element> elements_;
};

}  // namespace ruche
