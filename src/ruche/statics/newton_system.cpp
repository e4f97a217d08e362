#include "ruche/statics/newton_system.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "ruche/core/memory.hpp"

namespace ruche {
namespace {

constexpr double first_share = 0.1;
// A sheet that has just come to rest still has the noise of the turn in it: smaller shares are seldom enough.
// Where this is enough, the noise is gone with that step; where it is not, all of it comes next and less
// after.
constexpr double share_after_turning = 0.3;
constexpr double least_share = 0.005;  // below it none
constexpr double share_grows = 4.0;
constexpr double share_falls = 8.0;        // 16 makes stars slower, 4 strips
constexpr double rough_share_falls = 2.0;  // an eighth is mostly not enough there

}  // namespace

NewtonSystem::NewtonSystem(const Model& model, const std::vector<char>& held, bool loaded,
                           const std::vector<int>& vertex_order)
    : held_(held), loaded_(loaded), rigid_(model), cholesky_(model, vertex_order) {}

void NewtonSystem::build_matrix(const NewtonPoint& at, double shift) {
    const NodePattern& pattern = at.model.pattern();
    matrix_ = at.sums.hessian;
    rigid_.hold(pattern, at.x,
                at.order == Order::hessian ? RigidMotions::Resisting::supports_and_loads
                                           : RigidMotions::Resisting::supports,
                matrix_);
    const std::vector<int>& start = pattern.column_start();
    const std::vector<int>& row = pattern.row_index();
    const bool supported = !at.model.input().supports.empty();
    for (int column = 0; column < at.model.size() && (supported || shift != 0.0); ++column) {
        for (int k = start[column]; k < start[column + 1]; ++k) {
            if (row[k] == column) matrix_[k] += shift;
            if (held_[column] || held_[row[k]]) matrix_[k] = row[k] == column ? 1.0 : 0.0;
        }
    }
}

/// Solves for Newton's step as well, if one is asked for.
bool NewtonSystem::factorize(const NewtonPoint& at, double shift, Eigen::VectorXd* step) {
    build_matrix(at, shift);
    if (pattern_is_new_) cholesky_ = SparseCholesky(at.model, vertex_elimination_order(at.model.pattern()));
    pattern_is_new_ = false;
    ++factorizations_;
    const bool definite = step ? cholesky_.factorize_and_solve(matrix_, -at.sums.gradient, *step)
                               : cholesky_.factorize(matrix_);
    factor_is_near_ = definite && at.order == Order::hessian && shift == 0.0;
    return definite;
}

bool NewtonSystem::step_with_mean(const NewtonPoint& at, Eigen::VectorXd& step) {
    for (bool at_hand = at.order == form();; at_hand = false) {
        if (!at_hand) {
            at.model.evaluate(at.x, form(), mean_);
            mean_.gradient = at.sums.gradient;  // without the supports' reactions
        }
        const NewtonPoint mean = {at.model, at.x, at_hand ? at.sums : mean_, form()};
        if (factorize(mean, 0.0, &step)) return true;
        if (share_ == 1.0) return gauss_newton_step(mean, step);
        if (share_ == 0.0) {
            share_ = after_gauss_newton_ ? share_after_turning : first_share;
        } else {
            share_ = std::clamp(share_grows * share_, first_share, 1.0);
        }
    }
}

Order NewtonSystem::wanted(double rotation) const {
    return loaded_ || may_use_last_factor(rotation) ? Order::hessian : form();
}

void NewtonSystem::expect_indefinite() {
    share_ = share_after_turning;
    rough_ = true;
}

void NewtonSystem::adapt(bool halved) {
    if (halved) {
        share_ = std::clamp(share_grows * share_, 0.5 * first_share, 1.0);
    } else if (rough_) {
        share_ /= rough_share_falls;
    } else {
        share_ = after_gauss_newton_ && share_ < 1.0 ? 0.0 : share_ / share_falls;
        if (share_ < least_share) share_ = 0.0;
    }
    after_gauss_newton_ = false;
    rough_ = false;
}

/// The exact step to a part in a thousand, or to what `tolerance` asks for; where that would take long, what
/// is reached then, and the factor is not near any more. False when that is little or the Hessian is not
/// positive definite.
bool NewtonSystem::solve_with_last_factor(const NewtonPoint& at, double tolerance, Eigen::VectorXd& step) {
    constexpr double accuracy = 1e-3;  // of the residual
    constexpr int most_steps = 8;      // a solve costs about a tenth of a factorisation
    constexpr double useful = 0.05;    // of the residual: the next step has as much to do with the exact one
    constexpr double hopeful = 0.7;    // by which each step has to lower the residual as the factor weighs it
    build_matrix(at, 0.0);
    Eigen::VectorXd rest = -at.sums.gradient;
    const double first = rest.norm();
    const double enough = accuracy * first;
    const double at_rest = 0.7 * tolerance;  // in every component; the rest is for what is not linear
    cholesky_.narrow();
    Eigen::VectorXd direction = cholesky_.solve(rest);
    double product = rest.dot(direction);
    const double first_product = product;
    step.setZero(at.model.size());
    for (int i = 1;; ++i) {
        const Eigen::VectorXd pull = at.model.pattern().product(matrix_, direction);
        const double curvature = direction.dot(pull);
        if (!(curvature > 0.0)) return false;
        step += (product / curvature) * direction;
        rest -= (product / curvature) * pull;
        const double left = rest.norm();
        if (left < enough || rest.cwiseAbs().maxCoeff() < at_rest) return true;
        if (i == most_steps) {
            factor_is_near_ = false;
            return left < useful * first;
        }
        // By the plain norm a step along a soft direction seems to go wrong: what it leaves behind are small
        // errors of stiff elements.
        const Eigen::VectorXd next = cholesky_.solve(rest);
        const double next_product = rest.dot(next);
        if (!(next_product <= std::pow(hopeful, 2 * i) * first_product)) return false;
        direction = next + (next_product / product) * direction;
        product = next_product;
    }
}

bool NewtonSystem::exact_step(const NewtonPoint& at, double rotation, double tolerance,
                              Eigen::VectorXd& step) {
    if (at.order == Order::hessian && may_use_last_factor(rotation) &&
        solve_with_last_factor(at, tolerance, step))
        return true;
    if (loaded_) {
        const double mean = mean_stiffness(at.model.pattern(), at.sums.hessian);
        bool ready = factorize(at, 0.0, &step);
        // The last one may have been far more than the soft directions need, which then hardly move: where
        // some parts are much stiffer than others the mean says nothing about those.
        const double first = shift_ > 0.0 ? std::max(0.1 * shift_, 1e-16 * mean) : 1e-9 * mean;
        for (shift_ = ready ? shift_ : first; !ready && shift_ < 1e3 * mean; shift_ *= 4.0)
            ready = factorize(at, shift_, &step);
        return ready && step.allFinite();
    }
    return step_with_mean(at, step) && step.allFinite();
}

bool NewtonSystem::gauss_newton_step(const NewtonPoint& at, Eigen::VectorXd& step) {
    const double mean = mean_stiffness(at.model.pattern(), at.sums.hessian);
    after_gauss_newton_ = true;
    bool ready = factorize(at, 0.0, &step);
    for (double shift = 1e-9 * mean; !ready && shift < 1e3 * mean; shift *= 100.0)
        ready = factorize(at, shift, &step);
    return ready && step.allFinite();
}

bool NewtonSystem::certify(const NewtonPoint& at) { return factorize(at); }

bool NewtonSystem::steepest_curvature(const NewtonPoint& at, Eigen::VectorXd& direction) {
    const double mean = mean_stiffness(at.model.pattern(), at.sums.hessian);
    bool ready = false;
    for (double shift = 1e-8 * mean; !ready && shift < 1e3 * mean; shift *= 10.0)
        ready = factorize(at, shift);
    if (!ready) return false;
    for (int i = 0; i < 20; ++i) direction = cholesky_.solve(direction.normalized()).col(0);
    return true;
}

std::string NewtonSystem::missing_memory(const Model& model, double limit_mb) const {
    constexpr double megabyte = 1e6;
    constexpr double matrices = 4.0;  // of the state, its mean, of a trial, the one that is factorised
    const double needed =
        1.05 * factor_megabytes() +
        matrices * sizeof(double) * static_cast<double>(model.pattern().row_index().size()) / megabyte;
    double available = static_cast<double>(memory_available()) / megabyte;
    if (limit_mb > 0.0) {
        const double left = limit_mb - static_cast<double>(memory_in_use()) / megabyte;
        available = std::min(available, left);
    }
    if (needed <= available) return {};
    return fmt::format(
        "not enough memory for this mesh: the factorisation needs {:.0f} MB more, {:.0f} MB are available",
        needed, std::max(0.0, available));
}

std::vector<char> held_unknowns(const Model& model) {
    std::vector<char> held(model.size(), 0);
    for (const Support& support : model.input().supports) {
        for (int c = 0; c < 3; ++c) held[3 * support.vertex + c] |= support.fixed[c] ? 1 : 0;
    }
    return held;
}

bool is_loaded(const ModelInput& sheet) { return !sheet.supports.empty() || !sheet.forces.empty(); }

double mean_stiffness(const NodePattern& pattern, const std::vector<double>& hessian) {
    double sum = 0.0;
    for (int node = 0; node < pattern.node_count(); ++node) {
        const int block = pattern.block_offset(node, node);
        for (int c = 0; c < pattern.node_size(node); ++c)
            sum += std::abs(hessian[block + c * pattern.column_length(node) + c]);
    }
    return sum / pattern.unknown_count();
}

bool at_rest_or_rounded(const NewtonPoint& at, double tolerance) {
    const NodePattern& pattern = at.model.pattern();
    const std::vector<int>& start = pattern.column_start();
    const std::vector<int>& row = pattern.row_index();
    constexpr double epsilon = std::numeric_limits<double>::epsilon();
    const double force = at.sums.gradient.cwiseAbs().maxCoeff();
    // Far from rest a bound tells, and its one pass over the Hessian.
    const Eigen::Map<const Eigen::VectorXd> values(at.sums.hessian.data(),
                                                   static_cast<Eigen::Index>(at.sums.hessian.size()));
    const double largest_term = values.cwiseAbs().maxCoeff() * at.x.cwiseAbs().maxCoeff();
    if (force > std::max(tolerance, epsilon * largest_term * at.model.size())) return false;
    Eigen::VectorXd limit = Eigen::VectorXd::Zero(at.x.size());
    for (Eigen::Index column = 0; column < at.x.size(); ++column) {
        for (int k = start[column]; k < start[column + 1]; ++k) {
            if (row[k] < column) continue;
            const double stiffness = std::abs(at.sums.hessian[k]);
            limit[row[k]] += stiffness * std::abs(at.x[column]);
            if (row[k] != column) limit[column] += stiffness * std::abs(at.x[row[k]]);
        }
    }
    limit *= epsilon;
    return (at.sums.gradient.cwiseAbs().array() <= limit.array().max(tolerance)).all();
}

}  // namespace ruche
