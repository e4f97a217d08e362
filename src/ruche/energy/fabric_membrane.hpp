#pragma once

#include <vector>

#include "ruche/energy/term.hpp"
#include "ruche/material/fabric_law.hpp"

namespace ruche {

/// Stretching energy of bare fabric (paper eqs 1-6):
///
///     W = h_f sum_t A_t Psi~(E_t),   E = (F^T F - I) / 2 in fabric axes
///
/// F maps the relaxed fabric (layout / pre-stretch) to the current shape; A_t is the relaxed area. E is
/// linear in the squared edge lengths.
class FabricMembrane {
  public:
    static constexpr std::string_view name = "fabric_membrane";
    static constexpr int vertex_slots = 3;
    static constexpr int edge_slots = 0;

    /// A bare triangle: its vertices and the relaxed positions of its corners in fabric axes, mm.
    struct Element {
        std::array<int, 3> vertices;
        std::array<Vec2, 3> relaxed;
    };

    FabricMembrane(const FabricLaw& law, double thickness, const std::vector<Element>& elements);

    int element_count() const { return static_cast<int>(elements_.size()); }
    std::array<int, 3> nodes(int element) const { return elements_[element].vertices; }
    Local<9> evaluate(int element, const Unknowns& x, Order order) const;

    /// Green's strain (E11, E22, 2 E12) in fabric axes.
    Vec3 green_strain(int element, const Unknowns& x) const;
    const FabricLaw& law() const { return law_; }
    /// The same elements with another law.
    FabricMembrane with_law(const FabricLaw& law) const {
        FabricMembrane other(*this);
        other.law_ = law;
        return other;
    }

  private:
    struct Prepared {
        std::array<int, 3> vertices;
        double volume;           // h_f times relaxed area
        Vec3 relaxed_lengths;    // squared
        Mat3 strain_of_lengths;  // E = M (L - L_relaxed)
    };
    FabricLaw law_;
    std::vector<Prepared> elements_;
};

}  // namespace ruche
