#include "ruche/study/sensitivity/sensitivity.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "ruche/material/cards.hpp"
#include "ruche/scene/build.hpp"
#include "ruche/statics/contact_guard.hpp"
#include "ruche/statics/shape_response.hpp"
#include "ruche/study/sensitivity/model_parameters.hpp"

namespace ruche {
namespace {

/// The model that the result is an equilibrium of.
Model model_at_rest(const Result& result) {
    const Eigen::VectorXd& x = result.equilibrium.x;
    Model model =
        Model(scene_model(result.scene, result.layout)).with_log_extension(result.equilibrium.log_extension);
    if (result.scene.model.contact) ContactGuard(model).cover(model, x, x);
    return model;
}

/// The scene's card; none where its file is gone (a record of an earlier run does not need it).
std::optional<MaterialCard> card_of_scene(const Scene& scene) {
    const std::string& card = scene.fabric.card;
    const bool is_file = is_card_path(card);
    const std::string path = is_file ? resolved_path(scene, card) : card;
    std::error_code ignored;
    if (is_file && !std::filesystem::exists(path, ignored)) return std::nullopt;
    return load_card(path);
}

std::optional<double> relative_half(const CardValue& value) {
    if (!value.interval || value.value == 0.0) return std::nullopt;
    return 0.5 * ((*value.interval)[1] - (*value.interval)[0]) / std::abs(value.value);
}

/// What the card says of a parameter: at the calibrated pre-stretch next to the scene's.
std::optional<double> card_uncertainty(const MaterialCard& card, const Scene& scene,
                                       const ModelParameter& parameter) {
    if (parameter.name == "plastic.thickness_mm")
        return card.printed_thickness ? relative_half(*card.printed_thickness) : std::nullopt;
    const ResolvedCard resolved = resolve_card(card, scene.fabric.prestretch);
    const double s = std::sqrt(scene.fabric.prestretch[0] * scene.fabric.prestretch[1]);
    const auto nearest = std::ranges::min_element(
        card.sets, {}, [&](const CardSet& set) { return std::abs(set.prestretch - s); });
    for (const Field<Material>& field : fields<Material>()) {
        if (parameter.name != "material." + std::string(field.key)) continue;
        if (get(resolved.material, field) != get(scene.material, field)) return std::nullopt;
        return relative_half(nearest->values.at(std::string(bare_name(info(field)))));
    }
    return std::nullopt;
}

}  // namespace

std::optional<double> Sensitivities::uncertainty(int measure) const {
    double squares = 0.0;
    bool any = false;
    for (std::size_t p = 0; p < parameters.size(); ++p) {
        if (!parameters[p].uncertainty) continue;
        const double part = slopes(measure, static_cast<Eigen::Index>(p)) * *parameters[p].uncertainty;
        squares += part * part;
        any = true;
    }
    return any ? std::optional(std::sqrt(squares)) : std::nullopt;
}

std::optional<Sensitivities> sensitivities(const Result& result, const Control& control) {
    const Model model = model_at_rest(result);
    const Eigen::VectorXd& x = result.equilibrium.x;
    ShapeResponse response(model, x);
    if (!response.stable()) return std::nullopt;

    const std::vector<ModelParameter> parameters = model_parameters(model.input());
    const auto count = static_cast<Eigen::Index>(parameters.size());
    const std::optional<MaterialCard> card = card_of_scene(result.scene);
    Sensitivities found;
    Eigen::MatrixXd changes(x.size(), count);
    for (Eigen::Index p = 0; p < count; ++p) {
        const ModelParameter& parameter = parameters[static_cast<std::size_t>(p)];
        control.say({"sensitivity", static_cast<double>(p) / static_cast<double>(count), parameter.name});
        const GradientChange change = gradient_change(model, x, parameter);
        changes.col(p) = change.gradient;
        found.parameters.push_back(
            {.name = parameter.name,
             .unit = parameter.unit,
             .value = parameter.value,
             .uncertainty = card ? card_uncertainty(*card, result.scene, parameter) : std::nullopt,
             .error = change.error / std::max(change.gradient.cwiseAbs().maxCoeff(), 1e-300)});
    }
    const Eigen::MatrixXd velocities = response.velocities(std::move(changes));

    const ShapeMeasures measures(result.layout, result.shape);
    found.measures = measures.values();
    found.slopes.resize(static_cast<Eigen::Index>(found.measures.size()), count);
    for (Eigen::Index p = 0; p < count; ++p) {
        const std::vector<double> rates =
            measures.rates(vertex_vectors(velocities.col(p), model.vertex_count()));
        for (std::size_t m = 0; m < rates.size(); ++m)
            found.slopes(static_cast<Eigen::Index>(m), p) = rates[m] / found.measures[m].value;
    }
    return found;
}

}  // namespace ruche
