#include "ruche/studio/run_summary.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <vector>

#include "ruche/core/document.hpp"

namespace ruche {

using Json = nlohmann::ordered_json;

static Json curvatures(const Json& strips) {
    std::vector<double> values;
    for (const Json& strip : strips)
        if (strip.at("curvature_per_mm").is_number()) values.push_back(strip.at("curvature_per_mm"));
    if (values.empty()) return nullptr;
    std::sort(values.begin(), values.end());
    return {values.front(), values[values.size() / 2], values.back()};
}

/// What the scene, the studio or an option said; what is merely the default is left out.
static Json given_settings(const Json& parameters) {
    Json settings = Json::object();
    for (const auto& [section, entries] : parameters.items()) {
        if (!entries.is_object() || section == "material" || section == "output") continue;
        for (const auto& [key, entry] : entries.items())
            if (entry.is_object() && entry.contains("source") && entry["source"] != "default")
                settings[section + "." + key] = entry["value"];
    }
    return settings;
}

std::string run_summary(const std::string& report) {
    constexpr std::size_t longest = 64U << 20U;
    try {
        const Json json = Json::parse(read_file(report, "report", longest));
        Json summary;
        for (const char* key : {"status", "stable", "message"}) summary[key] = json.at(key);
        summary["triangles"] = json.at("mesh").at("triangles");
        summary["seconds"] = json.at("solver").at("seconds");
        summary["energy_mJ"] = json.at("energy_mJ").at("total");
        summary["box_size_mm"] = json.at("shape").at("box_size_mm");
        summary["strips"] = json.at("strips").size();
        summary["curvature_per_mm"] = curvatures(json.at("strips"));
        summary["settings"] = given_settings(json.at("parameters"));
        summary["warnings"] = json.at("warnings").size();
        return summary.dump();
    } catch (const std::exception&) {
        return {};
    }
}

}  // namespace ruche
