#include "ruche/study/calibration/campaign.hpp"

namespace ruche {
namespace {

constexpr std::string_view modes[] = {"joint", "paper"};
constexpr std::string_view modulus_choices[] = {"secant", "tangent", "working", "stated"};
constexpr std::string_view grip_names[] = {"wide", "dogbone"};
constexpr std::string_view rest_lengths[] = {"auto", "gauge", "toe", "unloaded"};
constexpr std::string_view branch_names[] = {"unknown", "loading", "unloading"};
constexpr std::string_view printed_parameters[] = {"fabric_thickness", "fabric_youngs_modulus",
                                                   "plastic_youngs_modulus"};
constexpr double most_mm = 1e4;
constexpr std::string_view specimen_meaning =
    "Which specimen of a file that has several, one below the other or side by side, from 1; 0: there is "
    "one.";

}  // namespace

template <>
std::span<const Field<CampaignOptions>> fields<CampaignOptions>() {
    using C = CampaignOptions;
    static const Field<C> table[] = {
        {"name", &C::name, "", -infinity, infinity, "Name of the card."},
        {"description", &C::description, "", -infinity, infinity, "Which fabric and plastic it describes."},
        {"mode", choice<&C::mode>(modes), "", -infinity, infinity,
         "\"joint\": all orientations at once, against the simulated clamped sample. \"paper\": each axis by "
         "itself, as the paper does."},
        {"prestretch", &C::prestretch, "", 1.01, 3,
         "Pre-stretch that the tension tests are for, unless a test says otherwise. Each gives a set of the "
         "card."},
        {"element_size_mm", &C::element_size_mm, "mm", 0.2, 20,
         "Element size of the simulated clamped samples."},
    };
    return table;
}

template <>
std::span<const Field<FabricMeasurements>> fields<FabricMeasurements>() {
    using F = FabricMeasurements;
    static const Field<F> table[] = {
        {"thickness_pressure_kpa", &F::thickness_pressure_kpa, "kPa", 0, 1000,
         "Pressure of the thickness gauge's foot; knits are measured at 0.5 to 1 kPa."},
        {"sample_area_mm2", &F::sample_area_mm2, "mm^2", 0, 1e8,
         "Relaxed area of the pieces whose sample_mass_g is given."},
        {"poissons_ratio", &F::poissons_ratio, "", -0.99, 0.99,
         "Poisson's ratio, when it is known; else it comes from the widths in the tension tests."},
        {"youngs_modulus", choice<&F::youngs_modulus>(modulus_choices), "", -infinity, infinity,
         "Which Young's modulus the fabric under plastic gets: \"secant\" (a line through the whole "
         "unloading "
         "branch, as the paper does), \"tangent\" (at zero stretch), \"working\" (pulls as hard as the "
         "fabric's law at the pre-stretch) or \"stated\"."},
        {"youngs_modulus_mpa", &F::youngs_modulus_mpa, "MPa", 0, 1e5,
         "The value when youngs_modulus is \"stated\"."},
        {"neo_hookean_share", &F::neo_hookean_share, "", 0, 0.5,
         "Share of the Neo-Hookean term in the fabric's energy (paper eq. 5); part of the fit."},
    };
    return table;
}

template <>
std::span<const Field<PlasticMeasurements>> fields<PlasticMeasurements>() {
    using P = PlasticMeasurements;
    static const Field<P> table[] = {
        {"density_kg_per_m3", &P::density_kg_per_m3, "kg/m^3", 0, 30000,
         "Density of the printed plastic; else 1210 is assumed."},
        {"youngs_modulus_mpa", &P::youngs_modulus_mpa, "MPa", 0, 1e6,
         "Young's modulus of the printed plastic, when it is known; else from [[plastic_tension]]."},
        {"poissons_ratio", &P::poissons_ratio, "", -0.99, 0.5,
         "Poisson's ratio of the plastic; the laminate gets the mean of this and the fabric's."},
    };
    return table;
}

template <>
std::span<const Field<TensionTest>> fields<TensionTest>() {
    using T = TensionTest;
    static const Field<T> table[] = {
        {"file", &T::file, "", -infinity, infinity, "File of the test, relative to the campaign's folder."},
        {"specimen", &T::specimen, "", 0, 10000, specimen_meaning},
        {"angle_deg", &T::angle_deg, "deg", -180, 180, "Angle of the pull from the fabric's first axis."},
        {"length_mm", &T::length_mm, "mm", 1, most_mm, "Relaxed length between the clamps (or the marks)."},
        {"width_mm", &T::width_mm, "mm", 0.5, most_mm, "Relaxed width of the sample."},
        {"prestretch", &T::prestretch, "", 1.01, 3, "Pre-stretch that the test is for; else the campaign's."},
        {"grips", choice<&T::grips>(grip_names), "", -infinity, infinity,
         "\"wide\": the clamps hold the whole width, which the joint fit takes into account. \"dogbone\": "
         "the "
         "narrow part is measured, its width is free."},
        {"grip_width_mm", &T::grip_width_mm, "mm", 0, most_mm,
         "Width of a dogbone at the clamps, when length_mm and the displacement are those of the clamps."},
        {"gauge_length_mm", &T::gauge_length_mm, "mm", 0, most_mm, "Length of such a dogbone's narrow part."},
        {"cycle", &T::cycle, "", 0, 10000,
         "Which load-unload cycle, from 1; 0: the last complete one, with those before it that cannot be "
         "told from it."},
        {"branch", choice<&T::branch>(branch_names), "", -infinity, infinity,
         "\"unloading\", as fabric on a frame is released, or \"loading\" where nothing else was measured."},
        {"rest_length", choice<&T::rest_length>(rest_lengths), "", -infinity, infinity,
         "Where stretch begins: \"gauge\" (length_mm at displacement 0), \"toe\" (where the first loading "
         "begins to pull), \"unloaded\" (where the branch ceases to pull), or \"auto\": the gauge, and the "
         "toe "
         "where more than 2 % are slack."},
        {"pretension_n", &T::pretension_n, "N", 0, 1e5, "Rows with less force than this are left out."},
    };
    return table;
}

template <>
std::span<const Field<ShearTest>> fields<ShearTest>() {
    using T = ShearTest;
    static const Field<T> table[] = {
        {"file", &T::file, "", -infinity, infinity, "File of the test, relative to the campaign's folder."},
        {"specimen", &T::specimen, "", 0, 10000, specimen_meaning},
        {"angle_deg", &T::angle_deg, "deg", -180, 180,
         "Angle from the fabric's first axis to the direction from clamp to clamp."},
        {"height_mm", &T::height_mm, "mm", 1, most_mm, "Distance of the two clamps."},
        {"width_mm", &T::width_mm, "mm", 1, most_mm, "Width of the sample along the clamps."},
        {"largest_strain", &T::largest_strain, "", 0, 2,
         "Shear strain up to which the response counts as linear; 0: found from the data."},
    };
    return table;
}

template <>
std::span<const Field<CantileverTest>> fields<CantileverTest>() {
    using T = CantileverTest;
    static const Field<T> table[] = {
        {"angle_deg", &T::angle_deg, "deg", -180, 180, "Angle of the strip from the fabric's first axis."},
        {"side", &T::side, "", -infinity, infinity, "Which side was up: \"front\" or \"back\"."},
    };
    return table;
}

template <>
std::span<const Field<PlasticTest>> fields<PlasticTest>() {
    using T = PlasticTest;
    static const Field<T> table[] = {
        {"file", &T::file, "", -infinity, infinity, "File of the test, relative to the campaign's folder."},
        {"specimen", &T::specimen, "", 0, 10000, specimen_meaning},
        {"length_mm", &T::length_mm, "mm", 1, most_mm, "Length between the clamps (or the marks)."},
        {"width_mm", &T::width_mm, "mm", 0.1, most_mm, "Width of the strip."},
        {"thickness_mm", &T::thickness_mm, "mm", 0.01, 100, "Thickness of the strip as measured."},
        {"window", &T::window, "", 1e-4, 0.5, "Engineering strain up to which the tangent at zero is taken."},
    };
    return table;
}

template <>
std::span<const Field<PrintedSample>> fields<PrintedSample>() {
    using P = PrintedSample;
    static const Field<P> table[] = {
        {"scene", &P::scene, "", -infinity, infinity,
         "Scene file of what was printed; else length_mm, width_mm and thickness_mm of a single strip."},
        {"length_mm", &P::length_mm, "mm", 1, most_mm, "Length of the strip as printed."},
        {"width_mm", &P::width_mm, "mm", 0.1, 100, "Width of the strip as printed."},
        {"thickness_mm", &P::thickness_mm, "mm", 0.01, 20, "Thickness of the plastic as measured."},
        {"prestretch", &P::prestretch, "", 1.01, 3, "Pre-stretch on the frame; else the campaign's."},
        {"strip", &P::strip, "", -infinity, infinity,
         "Which strip of the scene was measured; else the mean curvature of all."},
        {"radius_mm", &P::radius_mm, "mm", 0.1, 1e5, "Radius that it took."},
        {"radius_error_mm", &P::radius_error_mm, "mm", 0, 1e4,
         "Standard deviation of that reading; 0: 3 % of the radius."},
    };
    return table;
}

template <>
std::span<const Field<PrintedFitOptions>> fields<PrintedFitOptions>() {
    using P = PrintedFitOptions;
    static const Field<P> table[] = {
        {"parameter", choice<&P::parameter>(printed_parameters), "", -infinity, infinity,
         "What is adjusted until the radii are met."},
        {"card", &P::card, "", -infinity, infinity,
         "Card of the values that no test of this campaign determines."},
    };
    return table;
}

template <>
std::span<const Readings<FabricMeasurements>> readings<FabricMeasurements>() {
    using F = FabricMeasurements;
    static const Readings<F> table[] = {
        {{"thickness_mm", "mm", 1e-3, 20,
          "Readings of the relaxed fabric's thickness; else 0.46 mm is assumed."},
         &F::thickness_mm},
        {{"areal_density_kg_per_m2", "kg/m^2", 1e-3, 20, "Mass per area of the relaxed fabric."},
         &F::areal_density_kg_per_m2},
        {{"sample_mass_g", "g", 1e-6, 1e5, "Instead of it: masses of pieces of sample_area_mm2."},
         &F::sample_mass_g},
    };
    return table;
}

template <>
std::span<const Readings<PlasticMeasurements>> readings<PlasticMeasurements>() {
    using P = PlasticMeasurements;
    static const Readings<P> table[] = {
        {{"thickness_mm", "mm", 1e-3, 20, "Readings of the printed plastic's thickness, for the record."},
         &P::thickness_mm},
    };
    return table;
}

template <>
std::span<const Readings<CantileverTest>> readings<CantileverTest>() {
    using C = CantileverTest;
    static const Readings<C> table[] = {
        {{"length_mm", "mm", 0.01, most_mm, "Lengths of the strip that hang over."}, &C::length_mm},
        {{"x_mm", "mm", 0.01, most_mm, "For each, the horizontal distance of the tip from the edge."},
         &C::x_mm},
        {{"y_mm", "mm", 0.01, most_mm, "For each, how far the tip hangs below the edge."}, &C::y_mm},
    };
    return table;
}

template <>
std::span<const std::string_view> required_keys<TensionTest>() {
    static constexpr std::string_view keys[] = {"file", "angle_deg", "length_mm", "width_mm"};
    return keys;
}

template <>
std::span<const std::string_view> required_keys<ShearTest>() {
    static constexpr std::string_view keys[] = {"file", "angle_deg", "height_mm", "width_mm"};
    return keys;
}

template <>
std::span<const std::string_view> required_keys<PlasticTest>() {
    static constexpr std::string_view keys[] = {"file", "length_mm", "width_mm", "thickness_mm"};
    return keys;
}

template <>
std::span<const std::string_view> required_keys<CantileverTest>() {
    static constexpr std::string_view keys[] = {"length_mm", "x_mm", "y_mm"};
    return keys;
}

template <>
std::span<const std::string_view> required_keys<PrintedSample>() {
    static constexpr std::string_view keys[] = {"radius_mm"};
    return keys;
}

}  // namespace ruche
