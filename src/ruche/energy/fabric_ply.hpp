#pragma once

#include <array>

#include "ruche/energy/term.hpp"
#include "ruche/material/fabric_law.hpp"
#include "ruche/material/laminate.hpp"

namespace ruche {

/// The fabric under one printed triangle with the law of bare fabric (model option fabric_ply = same_law) in
/// place of eq. 8's linear ply:
///
///     W = sum_q w_q (z1 - z0) A_relaxed Psi~(E(z_q))
///
/// E(z) is Green's strain, in fabric axes, of the metric a - 2 z b against the relaxed fabric; z_q and w_q
/// are those of Gauss' quadrature over the ply, whose thickness is the relaxed one. In the strain space of
/// the laminate, (L - L_layout, c), E(z) is linear: a - 2 z b has the squared edge lengths L_i - 4 z (c_j +
/// c_k), j and k being the other two edges.
class FabricPly {
  public:
    /// Exact for a quintic in z, and a hundred times as good as two in a released strip (theory page, 5.4).
    static constexpr int points = 3;

    /// Heights in mm along the front normal; corners in mm, in the layout and relaxed in fabric axes.
    struct Layer {
        double z0 = 0.0;
        double z1 = 0.0;
        std::array<Vec2, 3> layout;
        std::array<Vec2, 3> relaxed;
    };
    explicit FabricPly(const Layer& layer);

    /// Green's strain (E11, E22, 2 E12) in fabric axes at a point of the quadrature.
    Vec3 green_strain(int point, const FormVector& deviation) const;

    /// Energy (mJ) and its derivatives with respect to (L, c), as far as `order` asks; `gauss_newton` makes
    /// the tangent positive semidefinite.
    struct Response {
        double energy = 0.0;
        FormVector stress = FormVector::Zero();
        FormMatrix tangent = FormMatrix::Zero();
    };
    Response evaluate(const FabricLaw& law, const FormVector& deviation, Order order) const;

  private:
    double volume_;      // relaxed, mm^3
    Vec3 frame_strain_;  // on the printing frame
    std::array<Eigen::Matrix<double, 3, 6>, points> strain_of_deviation_;
};

}  // namespace ruche
