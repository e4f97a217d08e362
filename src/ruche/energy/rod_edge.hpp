#pragma once

#include <vector>

#include "ruche/energy/term.hpp"

namespace ruche {

/// One edge of a rod (a strip without width on the fabric): its stretching, and the fabric on both of its
/// sides that holds its section.
///
///     W = 1/2 E A L eps^2 + 4 k (tan^2(beta_l / 2) + tan^2(beta_r / 2)),   eps = (|b - a|^2 / L^2 - 1) / 2
///     beta_l = theta/2 - phi,  beta_r = theta/2 + phi,  phi = y / L
///
/// L is the edge's length in the layout, theta the dihedral angle between the two triangles at the edge, phi
/// the angle by which the rod's section is turned about the edge from the mean of the two triangles' normals,
/// k = k_B |e|^2 / A_e the stiffness of the hinge that the fabric would have there without a rod. The two
/// halves of the hinge lie between the section and a triangle each, so they are twice as stiff; for phi = 0
/// and small angles they store what the whole one does.
class RodEdge {
  public:
    static constexpr std::string_view name = "rod_edge";
    static constexpr int vertex_slots = 4;
    static constexpr int edge_slots = 1;

    /// Start, end and the opposite corners of the triangles on its left and right; the node of y.
    struct Element {
        std::array<int, 4> vertices;
        int unknown = -1;
        double length = 1.0;                ///< L, mm
        double stretching_stiffness = 0.0;  ///< E A, N
        double hinge_stiffness = 0.0;       ///< k, mJ
    };

    explicit RodEdge(std::vector<Element> elements) : elements_(std::move(elements)) {}

    int element_count() const { return static_cast<int>(elements_.size()); }
    std::array<int, 5> nodes(int element) const {
        const auto& [v, unknown, length, ea, k] = elements_[element];
        return {v[0], v[1], v[2], v[3], unknown};
    }
    Local<13> evaluate(int element, const Unknowns& x, Order order) const;

    /// max(|beta_l|, |beta_r|): how far the fabric is folded at the rod.
    double max_fold(int element, const Unknowns& x) const;

  private:
    std::vector<Element> elements_;
};

}  // namespace ruche
