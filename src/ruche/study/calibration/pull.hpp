#pragma once

#include <cmath>

#include "ruche/material/fabric_law_parameters.hpp"

namespace ruche {

using LawGradient = Eigen::Matrix<double, 1, static_cast<int>(law_parameter_count)>;

/// What a material point answers to a pull: nothing holds its width or its shear.
struct PullPoint {
    double stress = 0.0;                ///< S along the pull (second Piola-Kirchhoff), MPa
    double transverse = 0.0;            ///< Green strain across the pull
    double shear = 0.0;                 ///< 2 E between the two
    double stress_by_strain = 0.0;      ///< dS/dE along the pull, the rest free, MPa
    double transverse_by_strain = 0.0;  ///< dE_tt/dE likewise
    LawGradient stress_by_parameter = LawGradient::Zero();
    LawGradient transverse_by_parameter = LawGradient::Zero();
    bool found = false;  ///< an equilibrium was found
};

/// The fabric's law in a uniaxial tension test at an angle to e_1: for a given Green strain along the pull
/// the transverse and shear strain for which S_tt = S_dt = 0, by Newton's method on the energy, which they
/// minimise. Derivatives by the implicit function theorem:
///
///     dS_dd/dp = (dS_d/dp) - T_df T_ff^-1 (dS_f/dp),   dE_f/dp = -T_ff^-1 (dS_f/dp)
///
/// with f the two free components and T the tangent in the axes of the pull.
class Pull {
  public:
    Pull(const Material& material, const FabricLaw::Options& options, double angle_deg);

    /// Begins with the strains found last; neighbouring calls are quick.
    PullPoint at(double green_strain, bool derivatives);

  private:
    Material material_;
    FabricLaw::Options options_;
    FabricLaw law_;
    Mat3 turn_;  // strain in the axes of the pull to fabric axes; stresses by the transpose
    Vec3 strain_ = Vec3::Zero();
};

/// Green strain and second Piola-Kirchhoff stress of a tension test from what the machine gives, with the
/// stretch lambda = 1 + d/l (paper eq. 9; Volino, Magnenat-Thalmann, Faure 2009):
///
///     E = d/l + d^2/(2 l^2) = (lambda^2 - 1)/2,    P = f/(w h_f),    S = P/lambda
///
/// S because P = F S and the pull's direction keeps its direction, F d = lambda d.
inline double green_strain(double stretch) { return 0.5 * (stretch * stretch - 1.0); }
inline double stretch_of(double green) { return std::sqrt(1.0 + 2.0 * green); }

}  // namespace ruche
