#include "ruche/output/packed_sheet.hpp"

#include <nlohmann/json.hpp>

namespace ruche {

void add_layout(PackedArrays& arrays, const std::string& prefix, const PrintMesh& layout) {
    std::vector<int> triangles;
    std::vector<int> front_strip;
    std::vector<int> back_strip;
    std::vector<double> front;
    std::vector<double> back;
    for (std::size_t t = 0; t < layout.mesh.triangles.size(); ++t) {
        const Triangle& corners = layout.mesh.triangles[t];
        triangles.insert(triangles.end(), corners.begin(), corners.end());
        const StripPair strips = layout.strip.empty() ? StripPair{} : layout.strip[t];
        const Print print = layout.print.empty() ? Print{} : layout.print[t];
        front_strip.push_back(strips.front);
        back_strip.push_back(strips.back);
        front.push_back(print.front);
        back.push_back(print.back);
    }
    std::vector<double> flat;
    for (const Vec2& v : layout.mesh.vertices) flat.insert(flat.end(), {v.x(), v.y()});
    arrays.add_numbers(prefix + "triangles", triangles, 3);
    arrays.add_even(prefix + "layout_mm", flat, 2);
    arrays.add_even(prefix + "front_mm", front);
    arrays.add_even(prefix + "back_mm", back);
    arrays.add_numbers(prefix + "front_strip", front_strip);
    arrays.add_numbers(prefix + "back_strip", back_strip);
}

std::vector<double> coordinates(const std::vector<Vec3>& points) {
    std::vector<double> list;
    list.reserve(3 * points.size());
    for (const Vec3& p : points) list.insert(list.end(), {p.x(), p.y(), p.z()});
    return list;
}

std::string index_json(const PackedArrays& arrays) {
    nlohmann::ordered_json index = nlohmann::ordered_json::object();
    for (const PackedArray& array : arrays.list()) {
        nlohmann::ordered_json entry = {
            {"type", array.type}, {"count", array.count}, {"components", array.components}, {"at", array.at}};
        if (!array.scale.empty()) {
            entry["origin"] = array.origin;
            entry["scale"] = array.scale;
        }
        index[array.name] = std::move(entry);
    }
    return index.dump();
}

}  // namespace ruche
