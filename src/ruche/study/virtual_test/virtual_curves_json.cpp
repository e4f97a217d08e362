#include <nlohmann/json.hpp>

#include "ruche/study/virtual_test/virtual_curves.hpp"

namespace ruche {

using Json = nlohmann::ordered_json;

template <class Struct>
static Json fields_json(const Struct& s) {
    Json json = Json::object();
    for (const Field<Struct>& field : fields<Struct>())
        std::visit([&](const auto& value) { json[std::string(field.key)] = value; }, get(s, field));
    return json;
}

static Json origin_json(const VirtualSamples& samples, const Material& material) {
    return {
        {"version", RUCHE_VERSION}, {"samples", fields_json(samples)}, {"material", fields_json(material)}};
}

std::string to_json(const VirtualCurves& curves) {
    Json json = origin_json(curves.samples, curves.material);
    json["curves"] = Json::array();
    for (const VirtualCurve& curve : curves.curves)
        json["curves"].push_back({{"test", curve.test},
                                  {"angle_deg", curve.angle},
                                  {"displacement_mm", curve.displacement},
                                  {"force_N", curve.force},
                                  {"width_mm", curve.width}});
    json["droops"] = Json::array();
    for (const VirtualDroop& droop : curves.droops)
        json["droops"].push_back(
            {{"angle_deg", droop.angle}, {"length_mm", droop.length}, {"x_mm", droop.x}, {"y_mm", droop.y}});
    return json.dump(1) + "\n";
}

std::optional<VirtualCurves> same_curves(const std::string& text, const VirtualSamples& samples,
                                         const Material& material) {
    try {
        const Json json = Json::parse(text);
        const Json origin = origin_json(samples, material);
        for (const auto& [key, value] : origin.items())
            if (json.at(key) != value) return std::nullopt;
        VirtualCurves result{.samples = samples, .material = material};
        for (const Json& curve : json.at("curves"))
            result.curves.push_back({curve.at("test"), curve.at("angle_deg"), curve.at("displacement_mm"),
                                     curve.at("force_N"), curve.at("width_mm")});
        for (const Json& droop : json.at("droops"))
            result.droops.push_back(
                {droop.at("angle_deg"), droop.at("length_mm"), droop.at("x_mm"), droop.at("y_mm")});
        return result;
    } catch (const Json::exception&) {
        return std::nullopt;
    }
}

}  // namespace ruche
