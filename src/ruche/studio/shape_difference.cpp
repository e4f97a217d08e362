#include "ruche/studio/shape_difference.hpp"

#include <nlohmann/json.hpp>

#include "ruche/geometry/rigid_alignment.hpp"
#include "ruche/meshing/point_locator.hpp"
#include "ruche/scene/state.hpp"

namespace ruche {

static Vec3 vertex(const State& state, int v) { return state.x.segment<3>(Eigen::Index{3} * v); }

static Vec3 place(const State& state, const MeshPoint& point) {
    Vec3 sum = Vec3::Zero();
    const Triangle& corners = state.layout.triangles[static_cast<std::size_t>(point.triangle)];
    for (std::size_t k = 0; k < 3; ++k) sum += point.weights[k] * vertex(state, corners[k]);
    return sum;
}

std::string shape_difference(const std::string& first_state, const std::string& second_state) {
    constexpr double reach = 0.1;  // mm, at the borders: both meshes simplify them a little
    const State first = read_state(first_state);
    const State second = read_state(second_state);
    const PointLocator locator(first.layout);
    std::vector<Vec3> from;
    std::vector<Vec3> to;
    for (int v = 0; v < second.layout.vertex_count(); ++v) {
        const auto found = locator.find(second.layout.vertices[static_cast<std::size_t>(v)], reach);
        if (!found) continue;
        from.push_back(vertex(second, v));
        to.push_back(place(first, *found));
    }
    if (from.size() < 3)
        throw InputError({.file = second_state}, "its layout has no place in common with " + first_state,
                         "Results of the same drawing can be compared.");
    const RigidAlignment motion = align(from, to);
    double largest = 0.0;
    for (std::size_t i = 0; i < from.size(); ++i)
        largest = std::max(largest, (motion.rotation * from[i] + motion.translation - to[i]).norm());
    nlohmann::json json = {{"rms_mm", motion.rms}, {"largest_mm", largest}};
    for (int row = 0; row < 3; ++row) {
        json["translation"].push_back(motion.translation[row]);
        for (int column = 0; column < 3; ++column) json["rotation"].push_back(motion.rotation(row, column));
    }
    return json.dump();
}

}  // namespace ruche
