#pragma once

#include <optional>
#include <vector>

#include "ruche/energy/fabric_ply.hpp"
#include "ruche/energy/term.hpp"
#include "ruche/material/laminate.hpp"

namespace ruche {

/// Energy of plastic on fabric (paper eq. 8 with true layer thicknesses; see material/laminate.hpp), with
///
///     a = [[L2, (L1+L2-L0)/2], [., L1]],   b = 2 [[c0+c1, c0], [c0, c0+c2]],   c_i = h_i sin(theta_i/2 +-
///     xi_i)
///
/// h_i is the current altitude onto edge i, theta_i the dihedral angle and xi_i = y_i / l_i the rotation of
/// the midedge normal about the edge (free edge normals; + in the first triangle of an edge, - in the
/// second). On an edge without a second normal c_i is eliminated (free rim: it takes the value of least
/// energy, a constant Schur complement because the energy is quadratic in c), an unknown of its own (open
/// rim: with a fabric ply of the fabric's own law the energy is not quadratic), or held at 0.
class LaminateTerm {
  public:
    static constexpr std::string_view name = "plastic";
    static constexpr int vertex_slots = 6;
    static constexpr int edge_slots = 3;

    /// What happens at each edge of a printed triangle.
    struct EdgeSide {
        enum class Kind {
            hinged,      ///< `flap` is the neighbour's opposite vertex
            free_rim,    ///< c is eliminated
            open_rim,    ///< c itself is the edge unknown
            clamped_rim  ///< c = 0: the face's own normal (the paper's operator on an outer boundary)
        } kind = Kind::free_rim;
        int flap = -1;             ///< vertex
        int unknown = -1;          ///< node number of y or c, -1 = averaged normals (xi = 0)
        double sign = 1.0;         ///< of xi in this triangle
        double mean_altitude = 1;  ///< l_e, mm
    };

    /// A printed triangle: corners in the layout (mm), plies in the basis (v1 - v0, v2 - v0) of the layout.
    struct Element {
        std::array<int, 3> vertices;
        std::array<Vec2, 3> layout;
        std::array<EdgeSide, 3> sides;
        std::vector<Ply> plies;
        std::optional<FabricPly::Layer> fabric;  ///< a further ply, of the fabric's own law
    };

    /// `law` is that of the elements' fabric plies; all elements have one, or none. No such element has a
    /// free rim.
    LaminateTerm(double poissons_ratio, const std::vector<Element>& elements,
                 const FabricLaw& law = FabricLaw(Material{}));

    int element_count() const { return static_cast<int>(elements_.size()); }
    std::array<int, 9> nodes(int element) const { return elements_[element].nodes; }
    Local<21> evaluate(int element, const Unknowns& x, Order order) const;

    /// max over the edges of |theta/2 +- xi|, which must stay below pi/2.
    double max_normal_rotation(int element, const Unknowns& x) const;
    /// Takes whole turns out of the rotations xi in x.
    void unwind(Eigen::VectorXd& x, int vertex_count) const;

    /// Whether the fabric plies have the fabric's own law, and their strains then.
    bool has_fabric_law() const { return !fabric_.empty(); }
    const FabricLaw& law() const { return law_; }
    std::array<Vec3, FabricPly::points> fabric_strains(int element, const Unknowns& x) const;
    /// The same elements with another law for the fabric.
    LaminateTerm with_law(const FabricLaw& law) const {
        LaminateTerm other(*this);
        other.law_ = law;
        return other;
    }

  private:
    struct Prepared {
        std::array<int, 9> nodes;       // v0 v1 v2, flaps, edge unknowns; -1 = none
        std::array<double, 3> y_to_xi;  // sign / l_e; 1 on an open rim; 0 without an unknown
        Vec3 layout_lengths;            // squared
        FormMatrix quadratic;           // in (L - L_layout, c), free rims eliminated
        FormVector linear;
        double constant;
    };
    struct Kinematics;
    Kinematics kinematics(const Prepared& element, const Unknowns& x) const;
    /// First and second derivatives of the energy in the strain space (L - L_layout, c).
    struct StrainResponse {
        const FormVector& strain;
        FormVector stress;
        const FormMatrix& tangent;
    };
    /// Adds gradient and Hessian by the unknowns to `local`.
    static void differentiate(const Prepared& element, const Kinematics& k, const StrainResponse& response,
                              Order order, Local<21>& local);

    std::vector<Prepared> elements_;
    std::vector<FabricPly> fabric_;  // none, or one per element
    FabricLaw law_;
};

}  // namespace ruche
