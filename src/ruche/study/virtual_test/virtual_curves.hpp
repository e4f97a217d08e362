#pragma once

#include <optional>
#include <string>
#include <vector>

#include "ruche/core/control.hpp"
#include "ruche/material/material.hpp"
#include "ruche/study/virtual_test/virtual_samples.hpp"

namespace ruche {

/// What the simulator says that one sample answers, without a machine's imperfections.
struct VirtualCurve {
    std::string test;                  ///< "tension", "shear", "plastic"
    double angle = 0.0;                ///< degrees
    std::vector<double> displacement;  ///< of the clamp, mm; increasing from 0
    std::vector<double> force;         ///< N
    std::vector<double> width;         ///< half-way between the clamps, mm; tension only
};

/// A strip that hangs over an edge.
struct VirtualDroop {
    double angle = 0.0;   ///< degrees
    double length = 0.0;  ///< mm
    double x = 0.0;       ///< reach of its tip, mm
    double y = 0.0;       ///< drop of its tip, mm
};

/// All tests of one card, and what they were made with.
struct VirtualCurves {
    VirtualSamples samples;
    Material material;
    std::vector<VirtualCurve> curves;
    std::vector<VirtualDroop> droops;
};

/// Simulates every test of `samples`. Throws InputError for contradictions, std::runtime_error when a sample
/// has no certified equilibrium, or `control` stops it.
VirtualCurves simulate_tests(const VirtualSamples& samples, const Material& material,
                             const Control& control = {});

/// As JSON, exactly.
std::string to_json(const VirtualCurves& curves);

/// The curves of a file that `to_json` wrote for the same samples and material, to the last bit; nothing for
/// any other file.
std::optional<VirtualCurves> same_curves(const std::string& json, const VirtualSamples& samples,
                                         const Material& material);

}  // namespace ruche
