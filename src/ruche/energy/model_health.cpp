#include <algorithm>
#include <cmath>
#include <numbers>

#include "ruche/energy/model_parts.hpp"

namespace ruche {

double Model::typical_force(const Eigen::VectorXd& x) const {
    const Unknowns unknowns = parts_->unknowns(x);
    double sum = 0.0;
    const auto add = [&](const auto& term) {
        for (int e = 0; e < term.element_count(); ++e) {
            sum += term.evaluate(e, unknowns, Order::gradient).gradient.template head<9>().squaredNorm();
        }
    };
    add(parts_->membrane->term());
    add(parts_->laminate->term());
    return std::sqrt(sum / (3.0 * parts_->input.mesh.triangle_count()));
}

int Model::elements_beyond_law(const Eigen::VectorXd& x) const {
    const Unknowns unknowns = parts_->unknowns(x);
    const FabricMembrane& membrane = parts_->membrane->term();
    int count = 0;
    for (int e = 0; e < membrane.element_count(); ++e) {
        const Vec3 strain = membrane.green_strain(e, unknowns);
        const bool beyond =
            strain[0] > membrane.law().strain_limit(0) || strain[1] > membrane.law().strain_limit(1);
        count += beyond ? 1 : 0;
    }
    return count;
}

Health Model::health(const Eigen::VectorXd& x) const {
    const Unknowns unknowns = parts_->unknowns(x);
    const TriangleMesh& mesh = parts_->input.mesh;
    constexpr double degrees = 180.0 / std::numbers::pi;
    Health health;
    health.max_strain_margin = -infinity;
    const FabricMembrane& membrane = parts_->membrane->term();
    for (int e = 0; e < membrane.element_count(); ++e) {
        const Vec3 strain = membrane.green_strain(e, unknowns);
        for (int i = 0; i < 2; ++i)
            health.max_strain_margin =
                std::max(health.max_strain_margin, strain[i] - membrane.law().gamma(i));
    }
    health.beyond_law = elements_beyond_law(x);
    const double relaxed_share = 1.0 / (parts_->input.prestretch[0] * parts_->input.prestretch[1]);
    std::vector<Vec3> normals(mesh.triangles.size());
    for (int t = 0; t < mesh.triangle_count(); ++t) {
        const Triangle& tri = mesh.triangles[t];
        const Vec3 a = unknowns.position(tri[0]);
        const Vec3 normal = (unknowns.position(tri[1]) - a).cross(unknowns.position(tri[2]) - a);
        const double twice_area = normal.norm();
        const double rest = layout_area(mesh, t) * (parts_->input.print[t].bare() ? relaxed_share : 1.0);
        health.min_area_ratio = std::min(health.min_area_ratio, 0.5 * twice_area / rest);
        normals[t] = normal / twice_area;
    }
    double sharpest = 1.0;  // cosine
    Vec3 sine = Vec3::Zero();
    for (const Edge& edge : parts_->edges.edges) {
        if (edge.on_boundary()) continue;
        const Vec3& left = normals[edge.triangle[0]];
        const Vec3& right = normals[edge.triangle[1]];
        const double cosine = left.dot(right);
        if (!(cosine <= sharpest)) continue;
        sharpest = cosine;
        sine = left.cross(right);
    }
    health.max_dihedral_deg = std::atan2(sine.norm(), sharpest) * degrees;
    const LaminateTerm& laminate = parts_->laminate->term();
    for (int e = 0; e < laminate.element_count(); ++e) {
        health.max_edge_rotation_deg =
            std::max(health.max_edge_rotation_deg, laminate.max_normal_rotation(e, unknowns) * degrees);
    }
    for (const ContactPair& pair : contacts()) {
        const double gap = distance(pair.kind, corners(pair, unknowns));
        if (gap >= pair.reach) continue;
        // What only takes back a double count is no pair of its own.
        health.contact_pairs += pair.area > 0.0 ? 1 : 0;
        health.smallest_gap = std::min(health.smallest_gap, gap);
    }
    return health;
}

}  // namespace ruche
