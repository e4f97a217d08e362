#include "ruche/study/virtual_test/virtual_samples.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "ruche/core/suggest.hpp"
#include "ruche/core/text_scan.hpp"

namespace ruche {

template <>
std::span<const Field<VirtualSamples>> fields<VirtualSamples>() {
    using S = VirtualSamples;
    static const Field<S> table[] = {
        {"tests", &S::tests, "", -infinity, infinity,
         "Which tests are made: tension, shear, cantilever, plastic."},
        {"prestretch", &S::prestretch, "", 1.01, 3,
         "Set of the card that is tested; the tension tests go up to this stretch."},
        {"angles_deg", &S::angles, "deg", -infinity, infinity,
         "Tension: angles from the fabric's first axis to the pull."},
        {"length_mm", &S::length, "mm", 1, 1e4, "Tension: length between the clamps."},
        {"width_mm", &S::width, "mm", 0.5, 1e4, "Tension: width of the strip; of a dogbone its narrow part."},
        {"grip_width_mm", &S::grip_width, "mm", 0, 1e4,
         "Tension: width of a dogbone at the clamps; 0 is a straight strip."},
        {"gauge_length_mm", &S::gauge_length, "mm", 0, 1e4, "Tension: length of a dogbone's narrow part."},
        {"shear_angles_deg", &S::shear_angles, "deg", -infinity, infinity,
         "Shear: angles from the fabric's first axis to the direction from clamp to clamp."},
        {"shear_side_mm", &S::shear_side, "mm", 1, 1e4, "Shear: side of the square between the clamps."},
        {"shear", &S::shear, "", 0.01, 1,
         "Shear: how far the clamp moves sideways, over the side of the square."},
        {"cantilever_lengths_mm", &S::cantilever_lengths, "mm", -infinity, infinity,
         "Cantilever: lengths that hang over the edge."},
        {"cantilever_angles_deg", &S::cantilever_angles, "deg", -infinity, infinity,
         "Cantilever: angles from the fabric's first axis to the strip."},
        {"cantilever_width_mm", &S::cantilever_width, "mm", 0.5, 1e4, "Cantilever: width of the strip."},
        {"plastic_length_mm", &S::plastic_length, "mm", 1, 1e4, "Plastic: length between the clamps."},
        {"plastic_width_mm", &S::plastic_width, "mm", 0.1, 1e3, "Plastic: width of the printed strip."},
        {"plastic_thickness_mm", &S::plastic_thickness, "mm", 0.01, 100,
         "Plastic: thickness of the printed strip."},
        {"plastic_strain", &S::plastic_strain, "", 0.001, 1, "Plastic: largest strain."},
        {"elements_across", &S::elements_across, "", 2, 200,
         "Elements across a tension strip, and a quarter of those across a shear square; with 10 the forces "
         "are "
         "within 0.05 % and 0.4 % of their limit."},
    };
    return table;
}

static std::string_view trimmed(std::string_view text) {
    const auto begin = text.find_first_not_of(" \t");
    if (begin == std::string_view::npos) return {};
    return text.substr(begin, text.find_last_not_of(" \t") - begin + 1);
}

static std::vector<std::string_view> entries(std::string_view list) {
    std::vector<std::string_view> found;
    for (bool more = true; more;) {
        const auto comma = list.find(',');
        found.push_back(trimmed(list.substr(0, comma)));
        more = comma != std::string_view::npos;
        if (more) list.remove_prefix(comma + 1);
    }
    return found;
}

std::vector<double> numbers_of(const std::string& list, const std::string& key, double low, double high) {
    std::vector<double> numbers;
    for (const std::string_view entry : entries(list)) {
        double number = 0.0;
        if (!read_number(entry, number) || !(number >= low && number <= high))
            throw InputError({.key = key},
                             fmt::format("\"{}\" is not a number in [{}, {}]", entry, low, high),
                             "Write numbers with a decimal point, separated by commas: 0, 45, 90.");
        numbers.push_back(number);
    }
    return numbers;
}

bool includes(const VirtualSamples& samples, std::string_view test) {
    static const std::vector<std::string_view> known = {"tension", "shear", "cantilever", "plastic"};
    bool found = false;
    for (const std::string_view entry : entries(samples.tests)) {
        if (std::find(known.begin(), known.end(), entry) == known.end())
            throw InputError({.key = "tests"},
                             fmt::format("\"{}\" is no test{}", entry, did_you_mean(entry, known)),
                             "There are tension, shear, cantilever and plastic; separate them by commas.");
        found = found || entry == test;
    }
    return found;
}

}  // namespace ruche
