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

namespace {

/// Calls visit(strain) with the larger of E_ii - gamma_i of every element with fabric that follows its law.
template <class Visit>
void for_each_strain_margin(const FabricMembrane& membrane, const LaminateTerm& laminate,
                            const Unknowns& unknowns, const Visit& visit) {
    const auto margin = [](const FabricLaw& law, const Vec3& strain) {
        return std::max(strain[0] - law.gamma(0), strain[1] - law.gamma(1));
    };
    for (int e = 0; e < membrane.element_count(); ++e)
        visit(margin(membrane.law(), membrane.green_strain(e, unknowns)));
    if (!laminate.has_fabric_law()) return;
    for (int e = 0; e < laminate.element_count(); ++e) {
        double largest = -infinity;
        for (const Vec3& strain : laminate.fabric_strains(e, unknowns))
            largest = std::max(largest, margin(laminate.law(), strain));
        visit(largest);
    }
}

/// Whether fabric with this margin is in the linear extension of its law.
bool is_beyond_law(double margin, const ModelOptions& options) { return margin > -options.log_extension; }

}  // namespace

int Model::elements_beyond_law(const Eigen::VectorXd& x) const {
    int count = 0;
    const auto look = [&](double margin) { count += is_beyond_law(margin, parts_->input.options) ? 1 : 0; };
    for_each_strain_margin(parts_->membrane->term(), parts_->laminate->term(), parts_->unknowns(x), look);
    return count;
}

Health Model::health(const Eigen::VectorXd& x) const {
    const Unknowns unknowns = parts_->unknowns(x);
    const TriangleMesh& mesh = parts_->input.mesh;
    constexpr double degrees = 180.0 / std::numbers::pi;
    Health health;
    health.max_strain_margin = -infinity;
    const LaminateTerm& laminate = parts_->laminate->term();
    for_each_strain_margin(parts_->membrane->term(), laminate, unknowns, [&](double margin) {
        health.max_strain_margin = std::max(health.max_strain_margin, margin);
        health.beyond_law += is_beyond_law(margin, parts_->input.options) ? 1 : 0;
    });
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
    for (int e = 0; e < laminate.element_count(); ++e) {
        health.max_edge_rotation_deg =
            std::max(health.max_edge_rotation_deg, laminate.max_normal_rotation(e, unknowns) * degrees);
    }
    const RodEdge& rods = parts_->rod_edges->term();
    for (int e = 0; e < rods.element_count(); ++e) {
        health.max_edge_rotation_deg =
            std::max(health.max_edge_rotation_deg, rods.max_fold(e, unknowns) * degrees);
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
