#include "ruche/statics/contact_guard.hpp"

#include <algorithm>
#include <cmath>

#include "ruche/geometry/self_intersection.hpp"

namespace ruche {

bool passes_through_itself(const Model& model, const Eigen::VectorXd& x) {
    std::vector<Vec3> positions;
    for (int v = 0; v < model.vertex_count(); ++v) positions.emplace_back(x.segment<3>(3 * v));
    return !find_self_intersections(positions, model.input().mesh.triangles).empty();
}

ClearPath::ClearPath(const ContactSearch& search, const Eigen::VectorXd& start, const StateCurve& curve,
                     int pieces)
    : times_{0.0}, states_{start} {
    for (int i = 1; i <= pieces; ++i) {
        const double before = times_.back();
        const double t = static_cast<double>(i) / pieces;
        const Eigen::VectorXd next = curve(t);
        const double fraction = next.allFinite() ? search.clear_fraction(states_.back(), next) : 0.0;
        if (fraction >= 1.0) {
            times_.push_back(t);
            states_.push_back(next);
            continue;
        }
        if (fraction > 0.0) {
            times_.push_back(before + fraction * (t - before));
            states_.emplace_back((1.0 - fraction) * states_.back() + fraction * next);
        }
        break;
    }
}

Eigen::VectorXd ClearPath::at(double t) const {
    if (curve_) return curve_(t);
    if (t >= end()) return states_.back();
    const auto after = std::upper_bound(times_.begin(), times_.end(), t) - times_.begin();
    const double share = (t - times_[after - 1]) / (times_[after] - times_[after - 1]);
    return (1.0 - share) * states_[after - 1] + share * states_[after];
}

ContactGuard::ContactGuard(const Model& model)
    : search_(model.input().mesh, model.edges(), model.input().options.contact_distance,
              std::max(model.input().prestretch[0], model.input().prestretch[1])) {}

ClearPath ContactGuard::follow(const Eigen::VectorXd& x, const StateCurve& curve, double rotation) const {
    // A straight piece instead of a turn by an angle a shortens the sheet by a^2/8 halfway.
    constexpr double turn = 0.2;
    constexpr double most = 500.0;
    const double pieces = std::clamp(std::ceil(rotation / turn), 1.0, most);
    return {search_, x, curve, static_cast<int>(pieces)};
}

bool ContactGuard::clear(const Eigen::VectorXd& from, const Eigen::VectorXd& to) const {
    return search_.clear_fraction(from, to) >= 1.0;
}

bool ContactGuard::cover(Model& model, const Eigen::VectorXd& from, const Eigen::VectorXd& to) const {
    constexpr double nearly = 1.5;  // times a pair's reach
    const std::vector<ContactPair>& known = model.contacts();
    if (std::ranges::includes(known, search_.pairs(to, 1.0), in_order)) return false;
    std::vector<ContactPair> all = search_.pairs(to, nearly);
    const Unknowns at{from.data(), model.vertex_count()};
    for (const ContactPair& pair : known) {
        if (distance(pair.kind, corners(pair, at)) < nearly * pair.reach) all.push_back(pair);
    }
    std::ranges::sort(all, in_order);
    all.erase(std::unique(all.begin(), all.end()), all.end());
    model.set_contacts(std::move(all));
    return true;
}

}  // namespace ruche
