#include <nlohmann/json.hpp>

#include "ruche/study/sensitivity/sensitivity.hpp"

namespace ruche {

std::string sensitivity_json(const Sensitivities& found, const std::string& scene) {
    using Json = nlohmann::ordered_json;
    Json json;
    json["version"] = RUCHE_VERSION;
    json["scene"] = scene;
    json["parameters"] = Json::object();
    for (const SensitivityParameter& parameter : found.parameters) {
        Json& entry = json["parameters"][parameter.name];
        entry = {{"value", parameter.value}, {"unit", parameter.unit}};
        if (parameter.uncertainty) entry["relative_uncertainty"] = *parameter.uncertainty;
        entry["derivative_error"] = parameter.error;
    }
    json["measures"] = Json::object();
    for (std::size_t m = 0; m < found.measures.size(); ++m) {
        const ShapeMeasure& measure = found.measures[m];
        const auto row = static_cast<Eigen::Index>(m);
        Json& entry = json["measures"][measure.name];
        entry = {{"value", measure.value}, {"unit", measure.unit}};
        if (const auto uncertainty = found.uncertainty(static_cast<int>(m)))
            entry["relative_uncertainty"] = *uncertainty;
        Json& slopes = entry["d_ln_by_d_ln"] = Json::object();
        for (std::size_t p = 0; p < found.parameters.size(); ++p)
            slopes[found.parameters[p].name] = found.slopes(row, static_cast<Eigen::Index>(p));
    }
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace ruche
