#pragma once

#include "ruche/study/calibration/campaign.hpp"
#include "ruche/study/calibration/cycles.hpp"

namespace ruche {

/// The branch of a tension test that is fitted, in what the law speaks of. The rows of the whole test are
/// kept for the report.
struct TensionCurve {
    TensionTest test;
    TestRecord record;
    std::vector<Cycle> cycles;
    std::size_t cycle = 0;               ///< the chosen one
    std::vector<std::size_t> used;       ///< it and those before it that say the same
    double rest_length = 0.0;            ///< mm, after slack was taken off
    double zero = 0.0;                   ///< displacement at which stretch begins, mm
    std::vector<double> stretch;         ///< lambda, of all cycles used, the largest first
    std::vector<double> nominal_stress;  ///< P = f/(w h_f), MPa
    std::vector<double> transverse;      ///< Green strain of the width; empty when not measured
    std::vector<std::string> warnings;

    double largest_stretch() const;
    double largest_stress() const;
    std::string name() const;         ///< "tension-15.csv (15 deg)"
    std::string used_cycles() const;  ///< "cycle 3", "cycles 1 to 3"
};

/// Reads a test's file, chooses the branch (of the cycle that is asked for; else of the last complete one and
/// of those that repeat it, see repeated_cycles), takes slack off, converts. A sample that barely stretches,
/// pulls absurdly hard or softly (units), has no unloading or too few rows is an InputError; what is only odd
/// is a warning.
TensionCurve read_tension_curve(const TensionTest& test, double fabric_thickness_mm);

/// Mean of -E22/E11 over a curve (paper after eq. 9), rows below a tenth of the largest strain left out,
/// where it is noise over nothing; NaN without widths.
double mean_poissons_ratio(const TensionCurve& curve);

/// Path without folders.
std::string file_name(const std::string& path);

}  // namespace ruche
