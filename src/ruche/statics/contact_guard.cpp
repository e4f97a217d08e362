#include "ruche/statics/contact_guard.hpp"

#include <algorithm>
#include <cmath>

#include "ruche/geometry/self_intersection.hpp"

namespace ruche {

bool passes_through_itself(const Model& model, const Eigen::VectorXd& x) {
    std::vector<Vec3> positions;
    positions.reserve(model.vertex_count());
    for (int v = 0; v < model.vertex_count(); ++v) positions.emplace_back(x.segment<3>(3 * v));
    return !find_self_intersections(positions, model.input().mesh.triangles).empty();
}

ClearPath::ClearPath(const ContactSearch& search, const Eigen::VectorXd& start, StateCurve curve, int pieces)
    : curve_(std::move(curve)), search_(&search), times_{0.0}, states_{start} {
    for (int i = 1; i <= pieces; ++i) {
        const double end = static_cast<double>(i) / pieces;
        if (!go_on_to(end)) break;
        if (times_.back() < end) break;
    }
}

/// Appends the state at t, or as far before it as the way there is clear; false when that is nowhere.
bool ClearPath::go_on_to(double t) {
    // The curve is not straight: as far as the chord is clear it may not be.
    constexpr double less = 0.95;
    constexpr int most_attempts = 10;
    const double from = times_.back();
    for (int attempt = 0; attempt < most_attempts; ++attempt) {
        const Eigen::VectorXd next = curve_(t);
        const double clear = next.allFinite() ? search_->clear_fraction(states_.back(), next) : less;
        if (clear >= 1.0) {
            times_.push_back(t);
            states_.push_back(next);
            return true;
        }
        t = from + less * clear * (t - from);
    }
    return false;
}

Eigen::VectorXd ClearPath::at(double t) const {
    if (search_ == nullptr) return curve_(t);
    if (t >= end()) return states_.back();
    const auto before = std::upper_bound(times_.begin(), times_.end(), t) - times_.begin() - 1;
    if (times_[before] == t) return states_[before];
    const Eigen::VectorXd state = curve_(t);
    const bool clear = state.allFinite() && search_->clear_fraction(states_[before], state) >= 1.0;
    return clear ? state : states_[before];
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
