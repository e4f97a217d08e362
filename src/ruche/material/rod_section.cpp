#include "ruche/material/rod_section.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ruche {

double torsion_constant(double width, double thickness) {
    const double a = std::max(width, thickness);
    const double b = std::min(width, thickness);
    constexpr int last = 301;  // what is left out is below 1e-11 of the sum
    double sum = 0.0;
    for (int n = last; n > 0; n -= 2) sum += std::tanh(0.5 * n * std::numbers::pi * a / b) / std::pow(n, 5);
    return a * b * b * b / 3.0 * (1.0 - 192.0 * b / (std::pow(std::numbers::pi, 5) * a) * sum);
}

double stretching_stiffness(const RodSection& s) { return s.youngs_modulus * s.width * s.thickness; }

Vec3 turning_stiffness(const RodSection& s) {
    const double shear_modulus = s.youngs_modulus / (2.0 * (1.0 + s.poissons_ratio));
    return {shear_modulus * torsion_constant(s.width, s.thickness),
            s.youngs_modulus * s.width * std::pow(s.thickness, 3) / 12.0,
            s.youngs_modulus * s.thickness * std::pow(s.width, 3) / 12.0};
}

}  // namespace ruche
