#pragma once

#include <array>
#include <string>
#include <vector>

#include "ruche/core/fields.hpp"
#include "ruche/study/calibration/test_record.hpp"

namespace ruche {

enum class FitMode { joint, paper };
enum class YoungsModulusChoice { secant, tangent, working, stated };
enum class Grips { wide, dogbone };
enum class RestLength { automatic, gauge, toe, unloaded };

/// The keys outside of all tables.
struct CampaignOptions {
    std::string name;
    std::string description;
    FitMode mode = FitMode::joint;
    double prestretch = 1.7;       ///< of the tension tests that do not say otherwise
    double element_size_mm = 2.0;  ///< of the simulated clamped samples
};

/// [fabric]
struct FabricMeasurements {
    std::vector<double> thickness_mm;  ///< repeated readings
    double thickness_pressure_kpa = 0.0;
    std::vector<double> areal_density_kg_per_m2;
    std::vector<double> sample_mass_g;
    double sample_area_mm2 = 0.0;
    double poissons_ratio = -1.0;  ///< negative: from the widths
    YoungsModulusChoice youngs_modulus = YoungsModulusChoice::secant;
    double youngs_modulus_mpa = 0.0;  ///< when stated
    double neo_hookean_share = 0.01;
};

/// [plastic]
struct PlasticMeasurements {
    double density_kg_per_m3 = 0.0;   ///< 0: assumed
    double youngs_modulus_mpa = 0.0;  ///< 0: from [[plastic_tension]]
    double poissons_ratio = 0.5;
    std::vector<double> thickness_mm;  ///< of what was printed, for the record
};

/// What all tests with a file have in common.
struct TestFile {
    std::string file;  ///< seen from the program's working folder
    int specimen = 0;  ///< which of the file's, from 1; 0: it has one only
    ColumnOptions columns;
    Place place;  ///< of its table in the campaign
};

/// [[tension]]
struct TensionTest : TestFile {
    double angle_deg = 0.0;
    double length_mm = 0.0;
    double width_mm = 0.0;
    double prestretch = 0.0;  ///< 0: the campaign's
    Grips grips = Grips::wide;
    double grip_width_mm = 0.0;    ///< of a dogbone at the clamps; 0: the narrow part was measured by itself
    double gauge_length_mm = 0.0;  ///< of a dogbone: length of the narrow part
    int cycle = 0;                 ///< 0 = the last complete one
    Branch branch = Branch::unloading;
    RestLength rest_length = RestLength::automatic;
    double pretension_n = 0.0;  ///< rows below this force are left out
};

/// [[shear]]
struct ShearTest : TestFile {
    double angle_deg = 0.0;
    double height_mm = 0.0;       ///< between the clamps
    double width_mm = 0.0;        ///< along the clamps
    double largest_strain = 0.0;  ///< end of the linear range; 0: found
};

/// [[cantilever]]: one strip at several overhangs.
struct CantileverTest {
    double angle_deg = 0.0;
    std::string side = "front";
    std::vector<double> length_mm, x_mm, y_mm;
    Place place;
};

/// [[plastic_tension]]
struct PlasticTest : TestFile {
    double length_mm = 0.0;
    double width_mm = 0.0;
    double thickness_mm = 0.0;
    double window = 0.01;  ///< engineering strain up to which the tangent at zero is taken
};

/// [[printed]]: a strip that was printed and released, and what radius it took.
struct PrintedSample {
    std::string scene;  ///< a scene file of what was printed; or a single strip without fabric around it:
    double length_mm = 0.0;
    double width_mm = 0.0;
    double thickness_mm = 0.0;
    double prestretch = 0.0;
    std::string strip;  ///< id of the measured strip in the scene; empty: the mean of all
    double radius_mm = 0.0;
    double radius_error_mm = 0.0;  ///< standard deviation of the reading; 0: 3 % of the radius
    Place place;
};

enum class PrintedParameter { fabric_thickness, fabric_youngs_modulus, plastic_youngs_modulus };

/// [printed_fit]
struct PrintedFitOptions {
    PrintedParameter parameter = PrintedParameter::fabric_thickness;
    std::string card = "spandex-tpu95a";  ///< the values that no test of the campaign determines
};

template <>
std::span<const Field<CampaignOptions>> fields<CampaignOptions>();
template <>
std::span<const Field<FabricMeasurements>> fields<FabricMeasurements>();
template <>
std::span<const Field<PlasticMeasurements>> fields<PlasticMeasurements>();
template <>
std::span<const Field<TensionTest>> fields<TensionTest>();
template <>
std::span<const Field<ShearTest>> fields<ShearTest>();
template <>
std::span<const Field<CantileverTest>> fields<CantileverTest>();
template <>
std::span<const Field<PlasticTest>> fields<PlasticTest>();
template <>
std::span<const Field<PrintedSample>> fields<PrintedSample>();
template <>
std::span<const Field<PrintedFitOptions>> fields<PrintedFitOptions>();

/// A key that takes a number or a list of readings, beside the fields of a struct.
template <class Struct>
struct Readings {
    FieldInfo about;
    std::vector<double> Struct::*values;
};
template <class Struct>
std::span<const Readings<Struct>> readings() {
    return {};
}
template <>
std::span<const Readings<FabricMeasurements>> readings<FabricMeasurements>();
template <>
std::span<const Readings<PlasticMeasurements>> readings<PlasticMeasurements>();
template <>
std::span<const Readings<CantileverTest>> readings<CantileverTest>();

/// Keys that a table of the campaign cannot do without.
template <class Struct>
std::span<const std::string_view> required_keys() {
    return {};
}
template <>
std::span<const std::string_view> required_keys<TensionTest>();
template <>
std::span<const std::string_view> required_keys<ShearTest>();
template <>
std::span<const std::string_view> required_keys<PlasticTest>();
template <>
std::span<const std::string_view> required_keys<CantileverTest>();
template <>
std::span<const std::string_view> required_keys<PrintedSample>();

/// What was measured, and how: the file that `ruche calibrate` reads.
struct Campaign {
    std::string file;
    CampaignOptions options;
    FabricMeasurements fabric;
    PlasticMeasurements plastic;
    std::vector<TensionTest> tension;
    std::vector<ShearTest> shear;
    std::vector<CantileverTest> cantilever;
    std::vector<PlasticTest> plastic_tension;
    std::vector<PrintedSample> printed;
    PrintedFitOptions printed_fit;
};

/// Reads and checks a campaign file; the tests' own files are not read yet. Throws InputError.
Campaign read_campaign(const std::string& path);
/// The same from text; `file` is named in messages, and paths are relative to its folder.
Campaign parse_campaign(const std::string& text, const std::string& file);

/// The page of the manual with every key of a campaign file (Markdown).
std::string campaign_manual();

}  // namespace ruche
