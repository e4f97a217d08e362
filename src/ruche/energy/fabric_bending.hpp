#pragma once

#include <vector>

#include "ruche/energy/term.hpp"

namespace ruche {

/// Bending energy of fabric, a sum over hinges (paper eq. 7 with its factor corrected, see the theory page):
///
///     W = 1/2 k_B sum_e |e|^2 / A_e (2 tan(theta_e / 2))^2
///
/// |e| and A_e (area of both triangles) are those of the relaxed fabric; flat at rest. Hinges are the edges
/// between two bare triangles and between a bare and a printed one. Infinite at |theta| = pi.
class FabricBending {
  public:
    static constexpr std::string_view name = "fabric_bending";
    static constexpr int vertex_slots = 4;
    static constexpr int edge_slots = 0;

    /// Edge vertices a, b and opposite corners c, d of the triangles (a, b, c), (b, a, d); stiffness k_B
    /// |e|^2 / A_e in mJ.
    struct Hinge {
        std::array<int, 4> vertices;
        double stiffness;
    };

    explicit FabricBending(std::vector<Hinge> hinges) : hinges_(std::move(hinges)) {}

    int element_count() const { return static_cast<int>(hinges_.size()); }
    std::array<int, 4> nodes(int element) const { return hinges_[element].vertices; }
    Local<12> evaluate(int element, const Unknowns& x, Order order) const;

  private:
    std::vector<Hinge> hinges_;
};

}  // namespace ruche
