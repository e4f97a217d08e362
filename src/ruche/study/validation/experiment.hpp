#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "ruche/core/fields.hpp"
#include "ruche/study/cantilever_sample.hpp"
#include "ruche/study/clamped_sample.hpp"

namespace ruche {

/// What is measured on a run. All curvatures in 1/mm, positive where the concave side is the back.
enum class Measure {
    strip_curvature,        ///< of the strips' centre lines, mean
    silhouette_curvature,   ///< of a circle around the print as seen along the layout's y; with the strips'
                            ///< sign
    transverse_stretch,     ///< released over printed length around the layout's origin, mean over an annulus
    gauss_curvature,        ///< integral over an annulus of the layout, over its released area, 1/mm^2
    mean_curvature,         ///< the same for (k1 + k2)/2
    fitted_mean_curvature,  ///< (k1 + k2)/2 by quadrics fitted at the annulus' vertices, mean over its area
    larger_curvature,       ///< the same for the larger of k1 and k2
    smaller_curvature,      ///< the same for the smaller one
    helix_curvature,        ///< of the helix through the first strip's centre line, with the strips' sign
    helix_torsion,          ///< of that helix, 1/mm; positive: right-handed
    position_x,             ///< of the layout's point `at_mm`, mm
    position_z,             ///< the same, along the flat layout's front normal
    energy,                 ///< mJ
    bimetal_curvature,      ///< closed form of a narrow free strip, with the scene's thickness and side
    clamped_force,          ///< N, that a clamped sample of bare fabric is pulled with
    law_force,      ///< N, of the closed law times the sample's width: transverse and shear strain free
    hanging_slope,  ///< of a fabric cantilever: how far its tip hangs down over how far it reaches
    elastica_slope  ///< the same of the inextensible heavy elastica (study/calibration/elastica)
};

/// [[metric]]
struct MetricSpec {
    std::string name;
    Measure of = Measure::strip_curvature;
    std::string label;
    std::string unit;
    std::string strips;     ///< begin of the ids of the strips that count; empty: all
    double interior = 1.0;  ///< of strips and silhouettes: what lies inside this share of the print's box
    double middle = 1.0;    ///< of strips: this share of each centre line, around its middle
    double inner_mm = 0.0;  ///< annulus of the layout around `at_mm`
    double outer_mm = 1e5;
    std::array<double, 2> at_mm = {0, 0};
    double strain = 0.7;  ///< engineering strain of a clamped sample
    std::string over;     ///< another metric of the same run that this one is divided by
};

/// What a check says about values that all carry an uncertainty; it must hold for every value in it.
enum class CheckKind {
    falls,     ///< along the sweep
    rises,     ///< along the sweep
    positive,  ///< or `negative`: the sign
    negative,
    within,    ///< `relative` of the reference: another metric, or a curve
    exceeds,   ///< the other metric or variant
    ratio,     ///< to the other metric or variant lies in `range`
    in_range,  ///< the value itself lies in `range`
    resolved   ///< the uncertainty is at most `relative` of the value
};

/// [[check]]
struct CheckSpec {
    std::string says;
    CheckKind kind = CheckKind::falls;
    std::string metric;
    std::vector<std::string> variants;  ///< empty: each of the experiment's
    std::string other_variant;          ///< of exceeds and ratio; empty: the same one
    std::string other_metric;           ///< empty: the same one
    std::string reference;              ///< of within
    double relative = 0.0;
    std::array<double, 2> range = {0, 0};
    std::array<double, 2> where = {-1e9, 1e9};  ///< values of the sweep that count
    bool absolute = false;                      ///< magnitudes are compared
};

/// [[variant]]: changes to the scene, of all runs along the sweep.
struct VariantSpec {
    std::string name;
    std::string scene;             ///< another scene file than the experiment's
    std::vector<std::string> set;  ///< "section.key=value"
    bool quick = true;             ///< takes part in the quick subset
};

/// [sweep]
struct SweepSpec {
    std::string key;    ///< of the scene, or "pull.angle_deg", "hang.length_mm"
    std::string label;  ///< of the axis
    std::vector<double> values;
    std::vector<double> quick;  ///< values of the quick subset
    double spread = 0.0;        ///< error bars: the metric at the value plus and minus this
};

/// [[reference]]: a curve from elsewhere; a CSV file with one value per value of the sweep.
struct ReferenceCurve {
    std::string name;
    std::string label;
    std::string file;
    std::string axis;  ///< label of the plot that it is drawn in; empty: the first one
    std::vector<double> x, y;
};

/// [[picture]]: of one run on the finest mesh.
struct PictureSpec {
    std::string variant;
    std::string title;
    double at = 0.0;  ///< of the sweep
};

enum class ExperimentSet { paper, numerics, shell };

/// Their names, in that order.
std::span<const std::string_view> experiment_set_names();

/// One folder of `validation/`: an experiment.toml with the scenes it runs.
struct Experiment {
    std::string name;  ///< of the folder
    std::string file;  ///< experiment.toml
    std::string title;
    ExperimentSet set = ExperimentSet::paper;
    std::string shows;                  ///< what must be seen
    std::string known;                  ///< what is known, from where, and what cannot be compared
    std::string scene;                  ///< scene file, relative to the folder
    std::string variants_from;          ///< file whose [[variant]] tables come first, relative to the folder
    std::optional<ClampedSample> pull;  ///< clamped samples of the scene's fabric in place of releases
    std::optional<CantileverSample> hang;     ///< or strips of it that hang from a clamp
    std::vector<double> meshes = {1.0, 0.5};  ///< element sizes over the scene's, falling by one factor
    std::vector<double> quick_meshes;         ///< of the quick subset
    bool nested = false;  ///< finer meshes are the first one, each triangle divided into four
    SweepSpec sweep;
    std::vector<VariantSpec> variants;
    std::vector<MetricSpec> metrics;
    std::vector<ReferenceCurve> references;
    std::vector<PictureSpec> pictures;
    std::vector<CheckSpec> checks;
    bool quick = true;  ///< takes part in the quick subset

    const MetricSpec* metric(const std::string& wanted) const;
    const VariantSpec* variant(const std::string& wanted) const;
    const ReferenceCurve* reference(const std::string& wanted) const;
};

template <>
std::span<const Field<Experiment>> fields<Experiment>();
template <>
std::span<const Field<ClampedSample>> fields<ClampedSample>();
template <>
std::span<const Field<CantileverSample>> fields<CantileverSample>();
template <>
std::span<const Field<SweepSpec>> fields<SweepSpec>();
template <>
std::span<const Field<VariantSpec>> fields<VariantSpec>();
template <>
std::span<const Field<MetricSpec>> fields<MetricSpec>();
template <>
std::span<const Field<ReferenceCurve>> fields<ReferenceCurve>();
template <>
std::span<const Field<PictureSpec>> fields<PictureSpec>();
template <>
std::span<const Field<CheckSpec>> fields<CheckSpec>();

/// Reads `folder`/experiment.toml and the reference curves it names. Throws InputError with file, line and
/// key, also for checks, pictures and variants that name what is not there.
Experiment read_experiment(const std::string& folder);

/// Names of the experiments in a folder, sorted: its folders with an experiment.toml. Throws InputError when
/// there is none.
std::vector<std::string> experiment_names(const std::string& folder);

}  // namespace ruche
