#include "ruche/study/virtual_test/virtual_campaign.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <map>

#include "ruche/core/document.hpp"
#include "ruche/study/virtual_test/hung_weights.hpp"

namespace ruche {
namespace {

/// A source of noise for each file, so that one more sample does not change the others.
NoiseSource noise_source(const VirtualMachine& machine, int file) {
    std::seed_seq seeds{machine.seed, file};
    return NoiseSource(seeds);
}

std::string header(const VirtualCurves& curves, const VirtualMachine& machine, const std::string& card) {
    const Material& m = curves.material;
    return fmt::format(
        R"(# Simulated tests of the card "{}" at a pre-stretch of {}, written by ruche virtual-test: noise {} of full scale,
# hysteresis {}, seed {}. What was not measured here (thickness, density, E_f) has the card's value.
name = {}
description = {}
mode = "joint"
prestretch = {}
element_size_mm = {}

[fabric]
thickness_mm = {}
areal_density_kg_per_m2 = {}
youngs_modulus = "stated"
youngs_modulus_mpa = {}
neo_hookean_share = {}

[plastic]
density_kg_per_m3 = {}
)",
        card, curves.samples.prestretch, machine.noise, machine.hysteresis, machine.seed,
        toml_quoted(card + ", virtual tests"), toml_quoted("Simulated tests of the card " + card),
        curves.samples.prestretch, curves.samples.width / curves.samples.elements_across, m.fabric_thickness,
        m.fabric_areal_density, m.fabric_youngs_modulus, m.neo_hookean_share, m.plastic_density);
}

std::string table_of(const VirtualCurve& curve, const VirtualSamples& s, const std::string& file) {
    if (curve.test == "tension") {
        const std::string table =
            fmt::format("\n[[tension]]\nfile = \"{}\"\nangle_deg = {}\nlength_mm = {}\nwidth_mm = {}\n", file,
                        curve.angle, s.length, s.width);
        if (s.grip_width == 0.0) return table + "grips = \"wide\"\n";
        return table + fmt::format("grips = \"dogbone\"\ngrip_width_mm = {}\ngauge_length_mm = {}\n",
                                   s.grip_width, s.gauge_length);
    }
    if (curve.test == "shear")
        return fmt::format("\n[[shear]]\nfile = \"{}\"\nangle_deg = {}\nheight_mm = {}\nwidth_mm = {}\n",
                           file, curve.angle, s.shear_side, s.shear_side);
    return fmt::format(
        "\n[[plastic_tension]]\nfile = \"{}\"\nlength_mm = {}\nwidth_mm = {}\nthickness_mm = {}\n", file,
        s.plastic_length, s.plastic_width, s.plastic_thickness);
}

/// The droops at one angle as read with one side up.
std::string cantilever_table(const std::vector<VirtualDroop>& droops, const char* side, double noise_share,
                             NoiseSource& noise) {
    std::normal_distribution<double> normal;
    std::vector<double> lengths;
    std::vector<std::string> x;
    std::vector<std::string> y;
    for (const VirtualDroop& droop : droops) {
        const double sigma = noise_share * droop.length;
        lengths.push_back(droop.length);
        x.push_back(fmt::format("{:.3f}", droop.x + sigma * normal(noise)));
        y.push_back(fmt::format("{:.3f}", droop.y + sigma * normal(noise)));
    }
    return fmt::format(
        "\n[[cantilever]]\nangle_deg = {}\nside = \"{}\"\nlength_mm = [{}]\nx_mm = [{}]\ny_mm = [{}]\n",
        droops.front().angle, side, fmt::join(lengths, ", "), fmt::join(x, ", "), fmt::join(y, ", "));
}

}  // namespace

std::vector<LabFile> virtual_campaign(const VirtualCurves& curves, const VirtualMachine& machine,
                                      const std::string& card) {
    std::vector<LabFile> files;
    std::string campaign = header(curves, machine, card);
    std::map<std::string, int> count;
    int number = 0;
    for (const VirtualCurve& curve : curves.curves) {
        NoiseSource noise = noise_source(machine, number++);
        const std::string sample = fmt::format("{}-{}", curve.test, ++count[curve.test]);
        const std::string file = sample + ".csv";
        const bool weights = machine.format == MachineFormat::weights && curve.test == "tension";
        files.push_back({file, weights ? hung_weights_csv(curve, curves.samples.length, machine, noise)
                                       : machine_csv(record(curve, machine, noise), sample, machine.format)});
        campaign += table_of(curve, curves.samples, file);
    }
    std::map<double, std::vector<VirtualDroop>> by_angle;
    for (const VirtualDroop& droop : curves.droops) by_angle[droop.angle].push_back(droop);
    NoiseSource noise = noise_source(machine, number);
    for (const auto& [angle, droops] : by_angle)
        for (const char* side : {"front", "back"})
            campaign += cantilever_table(droops, side, machine.noise, noise);
    files.push_back({"campaign.toml", std::move(campaign)});
    return files;
}

}  // namespace ruche
