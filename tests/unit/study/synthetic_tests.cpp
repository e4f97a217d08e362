#include "synthetic_tests.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>

namespace ruche::test {

LawCurve exact_curve(const Material& material, double angle_deg, double largest_stretch, int rows) {
    LawCurve curve{.name = fmt::format("{} deg", angle_deg), .angle_deg = angle_deg};
    Pull pull(material, {}, angle_deg);
    for (int i = 0; i < rows; ++i) {
        const double stretch = largest_stretch + (1.005 - largest_stretch) * i / (rows - 1);
        const PullPoint point = pull.at(green_strain(stretch), false);
        curve.stretch.push_back(stretch);
        curve.nominal_stress.push_back(stretch * point.stress);
        curve.transverse.push_back(point.transverse);
    }
    return curve;
}

void add_noise(LawCurve& curve, double fraction, std::uint64_t seed) {
    std::mt19937_64 generator(seed);
    // By Box and Muller: std::normal_distribution may differ from one library to the next.
    const auto normal = [&] {
        const double u = (static_cast<double>(generator() >> 11U) + 0.5) * 0x1p-53;
        const double v = (static_cast<double>(generator() >> 11U) + 0.5) * 0x1p-53;
        return std::sqrt(-2.0 * std::log(u)) * std::cos(6.283185307179586 * v);
    };
    const double stress = *std::max_element(curve.nominal_stress.begin(), curve.nominal_stress.end());
    const double strain = -*std::min_element(curve.transverse.begin(), curve.transverse.end());
    for (double& p : curve.nominal_stress) p += fraction * stress * normal();
    for (double& e : curve.transverse) e += fraction * strain * normal();
}

std::string machine_csv(const LawCurve& unloading, const Material& material) {
    constexpr double length = 110.0;
    constexpr double width = 20.0;
    std::string csv = "Time (s),Extension (mm),Load (N),Width (mm)\n";
    const std::size_t rows = unloading.stretch.size();
    double time = 0.0;
    const auto row = [&](std::size_t i, double factor) {
        csv += fmt::format("{},{},{},{}\n", time, length * (unloading.stretch[i] - 1.0),
                           factor * unloading.nominal_stress[i] * width * material.fabric_thickness,
                           width * stretch_of(unloading.transverse[i]));
        time += 0.2;
    };
    for (std::size_t i = rows; i-- > 1;) row(i, 1.1);
    for (std::size_t i = 0; i < rows; ++i) row(i, 1.0);
    return csv;
}

TestFolder::TestFolder(const std::string& name) : path_("./" + name) {
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_);
}

TestFolder::~TestFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
}

std::string TestFolder::write(const std::string& name, const std::string& contents) const {
    const std::string file = path_ + "/" + name;
    std::ofstream(file, std::ios::binary) << contents;
    return file;
}

}  // namespace ruche::test
