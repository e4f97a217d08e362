#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "ruche/material/material.hpp"
#include "ruche/study/calibration/campaign.hpp"
#include "ruche/study/calibration/law_fit.hpp"

namespace ruche {

/// Tension of printed plastic: Young's modulus as the tangent at zero.
struct PlasticCurve {
    PlasticTest test;
    std::vector<double> strain, stress;  ///< engineering strain and stress of the first loading, MPa
    double modulus = 0.0;                ///< MPa
    double error = 0.0;                  ///< standard error
    double intercept = 0.0;
    std::vector<std::string> warnings;
};

/// The slope at zero of a parabola through the rows with a strain up to test.window.
[[nodiscard]] PlasticCurve read_plastic_curve(const PlasticTest& test);

/// The definitions of Young's modulus of the fabric under plastic, MPa.
struct FabricModulus {
    double secant = 0.0;   ///< slope of a line through the whole branch (S over E), mean over orientations
    double tangent = 0.0;  ///< the same of the lowest fifth of the branch
    double working =
        0.0;  ///< with which the linear ply pulls as hard as the law, both held at the pre-stretch
    double secant_spread = 0.0, tangent_spread = 0.0;  ///< standard deviation over orientations
};

/// E_f by each definition; working: see consistent_fabric_modulus.
FabricModulus fabric_modulus(std::span<const LawCurve> curves, const Material& material, double prestretch);

/// Curvature (1/mm) of a narrow strip of plastic on fabric: that of the free laminate, which is Timoshenko's
/// bimetal (1925; theory page, closed forms).
double strip_curvature(const Material& material, double prestretch, double plastic_thickness_mm);

}  // namespace ruche
