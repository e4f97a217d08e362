#include "ruche/study/validation/experiment.hpp"

namespace ruche {

namespace {
constexpr std::string_view experiment_sets[] = {"paper", "numerics", "shell"};
constexpr std::string_view measure_names[] = {
    "strip_curvature", "silhouette_curvature",  "transverse_stretch", "gauss_curvature",
    "mean_curvature",  "fitted_mean_curvature", "larger_curvature",   "smaller_curvature",
    "helix_curvature", "helix_torsion",         "position_x",         "position_z",
    "energy",          "bimetal_curvature",     "clamped_force",      "law_force",
    "hanging_slope",   "elastica_slope"};
constexpr std::string_view check_kinds[] = {"falls",   "rises", "positive", "negative", "within",
                                            "exceeds", "ratio", "in_range", "resolved"};
}  // namespace

std::span<const std::string_view> experiment_set_names() { return experiment_sets; }

template <>
std::span<const Field<Experiment>> fields<Experiment>() {
    using E = Experiment;
    static const Field<E> table[] = {
        {"title", &E::title, "", -infinity, infinity, "Heading in the report."},
        {"set", choice<&E::set>(experiment_sets), "", 0, 0,
         "Which set it belongs to: the paper's experiments, what numerical choices do, or known solutions of "
         "shells and rods."},
        {"shows", &E::shows, "", -infinity, infinity, "What must be seen."},
        {"known", &E::known, "", -infinity, infinity, "What is known, from where; what cannot be compared."},
        {"scene", &E::scene, "", -infinity, infinity, "Scene file, relative to the experiment's folder."},
        {"variants_from", &E::variants_from, "", -infinity, infinity,
         "File with [[variant]] tables that come before those written here, relative to the folder."},
        {"quick", &E::quick, "", 0, 0, "Whether it takes part in the quick subset."},
        {"nested", &E::nested, "", 0, 0,
         "Finer meshes are the first one, each triangle divided into four; element sizes fall by halves."},
    };
    return table;
}

template <>
std::span<const Field<ClampedSample>> fields<ClampedSample>() {
    using C = ClampedSample;
    static const Field<C> table[] = {
        {"length_mm", &C::length_mm, "mm", 0.1, 1e4, "Length between the clamps, at rest."},
        {"width_mm", &C::width_mm, "mm", 0.1, 1e4, "Width at rest."},
        {"angle_deg", &C::angle_deg, "deg", -360, 360, "From the fabric's first axis to the pull."},
        {"element_size_mm", &C::element_size_mm, "mm", 0.01, 1e3, "Edge length of the elements."},
    };
    return table;
}

template <>
std::span<const Field<CantileverSample>> fields<CantileverSample>() {
    using C = CantileverSample;
    static const Field<C> table[] = {
        {"length_mm", &C::length_mm, "mm", 0.1, 1e4, "Length beyond the clamp."},
        {"width_mm", &C::width_mm, "mm", 0.1, 1e4, "Width of the strip."},
        {"angle_deg", &C::angle_deg, "deg", -360, 360, "From the fabric's first axis to the strip."},
        {"columns", &C::columns, "", 4, 1000, "Elements along the strip."},
    };
    return table;
}

template <>
std::span<const Field<SweepSpec>> fields<SweepSpec>() {
    using S = SweepSpec;
    static const Field<S> table[] = {
        {"key", &S::key, "", -infinity, infinity,
         "Key of the scene that is swept, or of the sample: pull.angle_deg."},
        {"label", &S::label, "", -infinity, infinity, "What stands at the axis of plots."},
        {"spread", &S::spread, "", 0, infinity,
         "Error bars: the metric with the swept value larger and smaller by this."},
    };
    return table;
}

template <>
std::span<const Field<VariantSpec>> fields<VariantSpec>() {
    using V = VariantSpec;
    static const Field<V> table[] = {
        {"name", &V::name, "", -infinity, infinity, "Name in checks, tables and legends."},
        {"scene", &V::scene, "", -infinity, infinity, "Another scene file than the experiment's."},
        {"quick", &V::quick, "", 0, 0, "Whether it takes part in the quick subset."},
    };
    return table;
}

template <>
std::span<const Field<MetricSpec>> fields<MetricSpec>() {
    using M = MetricSpec;
    static const Field<M> table[] = {
        {"name", &M::name, "", -infinity, infinity, "Name in checks and tables."},
        {"of", choice<&M::of>(measure_names), "", 0, 0, "What is measured."},
        {"label", &M::label, "", -infinity, infinity, "What stands at the axis of plots; empty: no plot."},
        {"unit", &M::unit, "", -infinity, infinity, "Unit in tables."},
        {"strips", &M::strips, "", -infinity, infinity, "Only strips whose id begins so."},
        {"interior", &M::interior, "", 0.01, 1,
         "Only strips, or print, inside the middle share of the print's box."},
        {"middle", &M::middle, "", 0.05, 1, "Only the middle share of each strip's centre line."},
        {"inner_mm", &M::inner_mm, "mm", 0, 1e5, "Inner radius of the part of the layout that counts."},
        {"outer_mm", &M::outer_mm, "mm", 0, 1e5, "Outer radius of the part of the layout that counts."},
        {"at_mm", &M::at_mm, "mm", -1e5, 1e5, "Middle of that part, in the layout."},
        {"strain", &M::strain, "", -0.99, 10, "Engineering strain of a clamped sample."},
        {"over", &M::over, "", -infinity, infinity, "Another metric of the run; this one is divided by it."},
    };
    return table;
}

template <>
std::span<const Field<ReferenceCurve>> fields<ReferenceCurve>() {
    using R = ReferenceCurve;
    static const Field<R> table[] = {
        {"name", &R::name, "", -infinity, infinity, "Name in checks."},
        {"label", &R::label, "", -infinity, infinity, "Name in legends."},
        {"file", &R::file, "", -infinity, infinity,
         "CSV file with a header: value of the sweep, value of the reference."},
        {"axis", &R::axis, "", -infinity, infinity,
         "Label of the metric in whose plot it is drawn; else the first plot."},
    };
    return table;
}

template <>
std::span<const Field<PictureSpec>> fields<PictureSpec>() {
    using P = PictureSpec;
    static const Field<P> table[] = {
        {"variant", &P::variant, "", -infinity, infinity, "Which variant is shown."},
        {"title", &P::title, "", -infinity, infinity, "What stands below."},
        {"at", &P::at, "", -infinity, infinity, "At which value of the sweep."},
    };
    return table;
}

template <>
std::span<const Field<CheckSpec>> fields<CheckSpec>() {
    using C = CheckSpec;
    static const Field<C> table[] = {
        {"says", &C::says, "", -infinity, infinity, "The claim, as a sentence."},
        {"kind", choice<&C::kind>(check_kinds), "", 0, 0, "How it is checked."},
        {"metric", &C::metric, "", -infinity, infinity, "Name of the metric that is checked."},
        {"other_variant", &C::other_variant, "", -infinity, infinity, "Compared with this variant."},
        {"other_metric", &C::other_metric, "", -infinity, infinity, "Compared with this metric."},
        {"reference", &C::reference, "", -infinity, infinity, "A metric or reference curve."},
        {"relative", &C::relative, "", 0, infinity, "Largest share of the reference, or of the value."},
        {"range", &C::range, "", -infinity, infinity, "Smallest and largest value, or ratio."},
        {"where", &C::where, "", -infinity, infinity, "First and last value of the sweep that counts."},
        {"absolute", &C::absolute, "", 0, 0, "Whether magnitudes are compared."},
    };
    return table;
}

}  // namespace ruche
