#include "ruche/studio/live_shape.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "ruche/geometry/rigid_alignment.hpp"
#include "ruche/output/packed_sheet.hpp"

namespace ruche {

static std::vector<Vec3> turned_to_layout(const Iterate& iterate) {
    std::vector<Vec3> shape;
    std::vector<Vec3> flat;
    for (std::size_t v = 0; v < iterate.sheet.mesh.vertices.size(); ++v) {
        const Vec2& at = iterate.sheet.mesh.vertices[v];
        shape.emplace_back(iterate.x.segment<3>(static_cast<Eigen::Index>(3 * v)));
        flat.emplace_back(at.x(), at.y(), 0.0);
    }
    const RigidAlignment motion = align(shape, flat);
    for (Vec3& p : shape) p = motion.rotation * p + motion.translation;
    return shape;
}

void LiveShape::take(int job, const Iterate& iterate) {
    auto shape = std::make_shared<const std::vector<Vec3>>(turned_to_layout(iterate));
    const std::scoped_lock lock(mutex_);
    const bool same_mesh = layout_ && layout_->mesh.vertices == iterate.sheet.mesh.vertices &&
                           layout_->mesh.triangles == iterate.sheet.mesh.triangles &&
                           layout_->print == iterate.sheet.print;
    if (!same_mesh) {
        layout_ = std::make_shared<const PrintMesh>(
            PrintMesh{.mesh = iterate.sheet.mesh, .print = iterate.sheet.print});
        ++mesh_;
    }
    if (job != job_) history_.clear();
    job_ = job;
    ++version_;
    shape_ = std::move(shape);
    iteration_ = iterate.iteration;
    residual_ = iterate.residual;
    if (std::isfinite(residual_)) history_.push_back({iterate.sheet.mesh.triangle_count(), residual_});
}

int LiveShape::version() const {
    const std::scoped_lock lock(mutex_);
    return version_;
}

std::string LiveShape::json(int known_mesh) const {
    std::shared_ptr<const PrintMesh> layout;
    std::shared_ptr<const std::vector<Vec3>> shape;
    nlohmann::json json = nlohmann::json::object();
    int mesh = 0;
    {
        const std::scoped_lock lock(mutex_);
        if (!shape_) return "{}";
        layout = layout_;
        shape = shape_;
        mesh = mesh_;
        json = {{"job", job_},
                {"mesh", mesh_},
                {"version", version_},
                {"iteration", iteration_},
                {"residual_N", std::isfinite(residual_) ? nlohmann::json(residual_) : nlohmann::json()},
                {"triangles", layout_->mesh.triangle_count()}};
        nlohmann::json steps = nlohmann::json::array();
        for (const Step& step : history_) steps.push_back({step.triangles, step.residual});
        json["history"] = std::move(steps);
    }
    PackedArrays arrays;
    arrays.add_even("shape_mm", coordinates(*shape), 3);
    if (mesh != known_mesh) add_layout(arrays, "", *layout);
    json["arrays"] = nlohmann::json::parse(index_json(arrays));
    json["bytes"] = base64(arrays.bytes());
    return json.dump();
}

}  // namespace ruche
