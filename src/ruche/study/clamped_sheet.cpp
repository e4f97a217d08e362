#include "ruche/study/clamped_sheet.hpp"

#include <algorithm>
#include <cmath>

#include "ruche/meshing/structured.hpp"
#include "ruche/statics/equilibrium.hpp"

namespace ruche {

ClampedSheet::ClampedSheet(ModelInput sheet) : sheet_(std::move(sheet)) {
    const auto& vertices = sheet_.mesh.vertices;
    double low = infinity;
    double high = -infinity;
    for (const Vec2& p : vertices) {
        low = std::min(low, p.x());
        high = std::max(high, p.x());
    }
    const double tolerance = 1e-9 * (high - low);
    for (const Vec2& p : vertices) {
        fixed_clamp_.push_back(p.x() < low + tolerance ? 1 : 0);
        moving_clamp_.push_back(p.x() > high - tolerance ? 1 : 0);
    }
    for (const Edge& edge : find_edges(sheet_.mesh).edges)
        if (edge.on_boundary()) border_.push_back({edge.vertex[0], edge.vertex[1]});
}

ModelInput ClampedSheet::held_at(const Vec2& displacement) const {
    ModelInput input = sheet_;
    for (int v = 0; v < input.mesh.vertex_count(); ++v) {
        const Vec2& p = input.mesh.vertices[v];
        const bool clamped = fixed_clamp_[v] || moving_clamp_[v];
        const Vec2 at = moving_clamp_[v] ? Vec2(p + displacement) : p;
        input.supports.push_back({v, {clamped, clamped, true}, Vec3(at.x(), at.y(), 0.0)});
    }
    return input;
}

/// On the straight line through the last two states as far as it goes; the solver moves the clamped vertices
/// to where they are held, and the others along with them.
Eigen::VectorXd ClampedSheet::start(const Vec2& displacement) const {
    if (!last_) return Model(sheet_).initial();
    if (!before_last_) return last_->x;
    const Vec2 step = last_->displacement - before_last_->displacement;
    const double ahead =
        step.squaredNorm() > 0.0 ? (displacement - last_->displacement).dot(step) / step.squaredNorm() : 0.0;
    constexpr double farthest = 2.0;  // in steps: beyond it a line says nothing
    return last_->x + std::clamp(ahead, -farthest, farthest) * (last_->x - before_last_->x);
}

double ClampedSheet::mid_width(const Eigen::VectorXd& x) const {
    Vec2 ends = Vec2::Zero();
    for (Eigen::Index v = 0; v < std::ssize(fixed_clamp_); ++v) {
        if (fixed_clamp_[v] != 0) ends[0] = x[3 * v];
        if (moving_clamp_[v] != 0) ends[1] = x[3 * v];
    }
    const double middle = ends.mean();
    double low = infinity;
    double high = -infinity;
    for (const auto& [a, b] : border_) {
        const double xa = x[3 * a];
        const double xb = x[3 * b];
        if ((xa - middle) * (xb - middle) > 0.0 || xa == xb) continue;
        const double t = (middle - xa) / (xb - xa);
        const double y = (1.0 - t) * x[3 * a + 1] + t * x[3 * b + 1];
        low = std::min(low, y);
        high = std::max(high, y);
    }
    return high - low;
}

ClampedSheet::State ClampedSheet::hold(const Vec2& displacement) {
    const Model model(held_at(displacement));
    const Eigen::VectorXd from = start(displacement);
    const Equilibrium end = solve(model, {}, {}, &from);
    State state{.displacement = displacement, .x = end.x};
    state.converged = end.status == SolveStatus::converged && end.stable;
    const Eigen::VectorXd gradient = model.gradient(end.x);
    for (std::size_t v = 0; v < moving_clamp_.size(); ++v)
        if (moving_clamp_[v]) state.force += gradient.segment<2>(3 * static_cast<Eigen::Index>(v));
    state.mid_width = mid_width(end.x);
    if (state.converged) {
        before_last_ = std::move(last_);
        last_ = state;
    }
    return state;
}

TriangleMesh clamped_rectangle(double length_mm, double width_mm, double element_size_mm) {
    const int across = std::max(2, static_cast<int>(std::lround(width_mm / element_size_mm)));
    return rectangle_mesh(MeshKind::alternating, {.length = length_mm, .width = width_mm, .across = across});
}

}  // namespace ruche
