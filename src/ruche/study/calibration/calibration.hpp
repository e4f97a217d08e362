#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "ruche/core/control.hpp"
#include "ruche/material/cards.hpp"
#include "ruche/study/calibration/bending_fit.hpp"
#include "ruche/study/calibration/campaign.hpp"
#include "ruche/study/calibration/law_fit.hpp"
#include "ruche/study/calibration/moduli.hpp"
#include "ruche/study/calibration/shear_fit.hpp"
#include "ruche/study/calibration/tension_curve.hpp"

namespace ruche {

/// What was fitted at one pre-stretch.
struct CalibratedSet {
    double prestretch = 1.0;
    std::vector<TensionCurve> tests;
    std::vector<LawCurve> curves;  ///< one per test
    LawFit fit;
    std::vector<double> poissons_ratios;  ///< eq. 9, per test; NaN without widths
    FabricModulus fabric_modulus;
    std::optional<ShearModulus> sheared_alpha_3;  ///< of the shear tests, their free sides simulated
    int grip_rounds = 0;                          ///< how often the clamped samples were simulated
    double largest_grip_effect = 0.0;             ///< largest deviation of the force ratio from one
    double curvature_used = 0.0,
           curvature_working = 0.0;  ///< 1/mm, of a strip 0.6 mm thick with E_f as used, as working
};

/// How the radius of a printed sample came out.
struct PrintedOutcome {
    PrintedSample sample;
    double simulated_radius_mm = 0.0;
    bool certain = false;
};

struct PrintedFit {
    std::string parameter;  ///< bare field name
    double value = 0.0, low = 0.0, high = 0.0;
    std::vector<PrintedOutcome> samples;
    std::vector<std::string> warnings;
};

/// Everything that `ruche calibrate` found, ready for the card and the report.
struct Calibration {
    Campaign campaign;
    std::vector<CalibratedSet> sets;  ///< pre-stretches increase
    std::vector<ShearCurve> shear;
    std::optional<ShearModulus> shear_modulus;
    std::optional<BendingFit> bending;
    std::vector<PlasticCurve> plastic;
    std::optional<PrintedFit> printed;
    MaterialCard card;
    std::vector<std::string> warnings;
};

/// Reads all files of a campaign, fits, and makes the card. Throws InputError for what cannot be used; what
/// is doubtful is a warning, which the card repeats.
[[nodiscard]] Calibration calibrate(const Campaign& campaign, const Control& control = {});

}  // namespace ruche
