#pragma once

#include <string>
#include <vector>

#include "ruche/core/fields.hpp"

namespace ruche {

/// What lies on the bench of a virtual laboratory, and how far it is pulled. Numbers in lists are separated
/// by commas.
struct VirtualSamples {
    std::string tests = "tension, shear, cantilever, plastic";
    double prestretch = 1.7;  ///< the card's set; tension goes up to this stretch
    // Tension of fabric, paper 5.1
    std::string angles = "0, 15, 30, 45, 60, 75, 90";  ///< degrees from the first axis to the pull
    double length = 110.0;                             ///< between the clamps, mm
    double width = 20.0;
    double grip_width = 0.0;    ///< of a dogbone, at the clamps; 0 = a straight strip
    double gauge_length = 0.0;  ///< of a dogbone: of its narrow part
    // Shear, paper 5.2
    std::string shear_angles = "0, 90";
    double shear_side = 60.0;  ///< of the square, mm
    double shear = 0.3;        ///< largest sideways displacement over the side
    // Cantilever, paper 5.3
    std::string cantilever_lengths = "30, 40, 50, 60, 70";  ///< beyond the clamp, mm
    std::string cantilever_angles = "0, 90";
    double cantilever_width = 20.0;
    // Tension of printed plastic
    double plastic_length = 150.0;
    double plastic_width = 10.0;
    double plastic_thickness = 1.0;
    double plastic_strain = 0.05;
    // How finely the samples are simulated
    int elements_across = 10;
};

template <>
std::span<const Field<VirtualSamples>> fields<VirtualSamples>();

/// The numbers of one of the lists. Throws InputError, which names `key`, for what is no number, is outside
/// [low, high], and for an empty list.
std::vector<double> numbers_of(const std::string& list, const std::string& key, double low, double high);

/// Whether a test is among `samples.tests`. Throws InputError for words there that name no test.
bool includes(const VirtualSamples& samples, std::string_view test);

}  // namespace ruche
