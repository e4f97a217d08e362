#pragma once

#include <span>
#include <string>
#include <vector>

#include "ruche/study/calibration/campaign.hpp"

namespace ruche {

/// k_B of one orientation and side.
struct BendingGroup {
    double angle_deg = 0.0;
    std::string side;
    double stiffness = 0.0;       ///< N mm
    double relative_error = 0.0;  ///< standard error over value, from the scatter of all groups
    double chord_rms = 0.0;       ///< rad
    struct Point {
        double load = 0.0;    ///< Gamma with this group's k_B
        double aspect = 0.0;  ///< y/x as measured
    };
    std::vector<Point> points;
};

struct BendingFit {
    double stiffness = 0.0;        ///< mean over the groups, N mm
    double low = 0.0, high = 0.0;  ///< 95 % interval of that mean; equal to it when nothing is known
    bool has_interval = false;
    double smallest = 0.0, largest = 0.0;  ///< over the groups
    std::vector<BendingGroup> groups;
};

/// Bending stiffness from cantilevers (paper 5.3): for each orientation and side the k_B with which the
/// points (w g L^3 / k_B, chord angle) lie closest to the master curve; then the mean. The angle atan2(y, x)
/// of the chord is compared, not y/x: an error in x of a strip that hangs steeply would count without bound.
[[nodiscard]] BendingFit fit_bending(std::span<const CantileverTest> tests, double areal_density_kg_per_m2);

}  // namespace ruche
