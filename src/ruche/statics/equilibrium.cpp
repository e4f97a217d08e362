#include "ruche/statics/equilibrium.hpp"

#include <chrono>
#include <cmath>
#include <cstdio>
#include <optional>
#include <utility>

#include "ruche/core/error.hpp"
#include "ruche/core/parallel.hpp"
#include "ruche/statics/nonlinear_elimination.hpp"
#include "ruche/statics/retraction.hpp"
#include "ruche/statics/rigid_motions.hpp"
#include "ruche/statics/rounding.hpp"
#include "ruche/statics/sparse_cholesky.hpp"
#include "ruche/statics/starts.hpp"
#include "ruche/statics/tangle.hpp"
#include "ruche/statics/untangle.hpp"

namespace ruche {
namespace {

std::string short_number(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.1e", value);
    return text;
}

/// One run of Newton's method.
class Newton {
  public:
    Newton(const Model& model, const SolveOptions& options, const Control& control)
        : original_(&model),
          options_(options),
          control_(control),
          rigid_(model),
          vertex_order_(vertex_elimination_order(model.pattern())),
          retraction_(model, vertex_order_),
          cholesky_({model.size(), model.pattern().column_start(), model.pattern().row_index()},
                    elimination_order(model, vertex_order_)),
          held_(model.size(), 0),
          elimination_(model, held_),
          loaded_(!model.input().supports.empty() || !model.input().forces.empty()) {
        for (const Support& support : model.input().supports) {
            for (int c = 0; c < 3; ++c) held_[3 * support.vertex + c] |= support.fixed[c] ? 1 : 0;
        }
    }

    Equilibrium run(const Eigen::VectorXd& start);
    Eigen::VectorXd carried_over(const LayoutShape& start) { return transfer(start, model(), retraction_); }
    /// From now on no step leads into a tangle, and none turns the sheet far.
    void be_wary() { wary_ = true; }
    /// The last state of all runs that is no tangle; empty when there was none.
    const Eigen::VectorXd& last_good() const { return last_good_; }

  private:
    /// rms rotation of a step above which the sheet is "turning" and the Gauss-Newton form is the better
    /// model.
    static constexpr double turning = 0.05;
    static constexpr double wary_turn = 0.3;  // rad, rms: how far a wary step may turn the sheet

    void evaluate(Order order) { terms_ = evaluate(x_, order, sums_); }
    /// As the model does, with the supports' reactions taken out of the gradient.
    EnergyTerms evaluate(const Eigen::VectorXd& x, Order order, AssembledSums& sums) const {
        const EnergyTerms terms = model().evaluate(x, order, sums);
        for (int i = 0; i < model().size(); ++i) {
            if (held_[i]) sums.gradient[i] = 0.0;
        }
        return terms;
    }
    double residual() const { return sums_.gradient.cwiseAbs().maxCoeff(); }
    /// Mean magnitude of the Hessian's diagonal, N/mm.
    double mean_stiffness() const {
        const NodePattern& pattern = model().pattern();
        double sum = 0.0;
        for (int node = 0; node < pattern.node_count(); ++node) {
            const int block = pattern.block_offset(node, node);
            for (int c = 0; c < pattern.node_size(node); ++c) {
                sum += std::abs(sums_.hessian[block + c * pattern.column_length(node) + c]);
            }
        }
        return sum / model().size();
    }
    double energy_scale() const {
        return std::abs(terms_.fabric_membrane) + std::abs(terms_.fabric_bending) + std::abs(terms_.plastic) +
               std::abs(terms_.gravity);
    }

    bool narrow_extension();
    void build_matrix(Order order, double shift);
    bool factorize(Order order, double shift = 0.0);
    bool solve_with_last_factor();
    bool solve_step(Order order);
    bool line_search();
    void relax_spots();
    bool leave_saddle();
    bool is_good(const Eigen::VectorXd& x) const { return tangle(model().health(x)).empty(); }
    bool may_take(const Eigen::VectorXd& x) const { return !wary_ || is_good(x); }
    /// Where the exact Hessian comes first, shifted where it is indefinite: such steps stay in the basin they
    /// are in, which the Gauss-Newton form, blind to the geometric stiffness, readily leaves.
    bool exact_first() const { return loaded_ || largest_turn() < infinity; }
    double largest_turn() const {
        return wary_ ? std::min(wary_turn, options_.largest_turn) : options_.largest_turn;
    }
    bool drowns_in_rounding(double last_residual) const;
    void report() const;

    const Model& model() const { return narrowed_ ? *narrowed_ : *original_; }

    const Model* original_;
    std::optional<Model> narrowed_;  // the same sheet with the narrower linear extension of the law
    SolveOptions options_;
    const Control& control_;
    RigidMotions rigid_;
    std::vector<int> vertex_order_;
    Retraction retraction_;
    SparseCholesky cholesky_;
    std::vector<char> held_;
    NonlinearElimination elimination_;
    bool loaded_;  // supports or forces hold the sheet: what resists there is the geometric stiffness

    Eigen::VectorXd x_;
    Eigen::VectorXd step_;
    AssembledSums sums_;
    AssembledSums trial_;
    EnergyTerms terms_;
    std::vector<double> matrix_;
    double shift_ = 0.0;           // of the last indefinite Hessian, N/mm
    bool factor_is_near_ = false;  // the last factor is of an exact Hessian
    double rotation_ = infinity;   // rms of the last step
    int iterations_ = 0;
    int factorizations_ = 0;
    bool wary_ = false;
    Eigen::VectorXd last_good_;
};

/// Exchanges the model for one with a narrower linear extension when the shape leans on it.
bool Newton::narrow_extension() {
    const double narrow = options_.narrow_log_extension;
    if (narrow == 0.0 || narrowed_ || narrow >= model().input().options.log_extension ||
        model().elements_beyond_law(x_) == 0) {
        return false;
    }
    ModelInput input = model().input();
    input.options.log_extension = narrow;
    narrowed_.emplace(std::move(input));
    return true;
}

void Newton::build_matrix(Order order, double shift) {
    const NodePattern& pattern = model().pattern();
    matrix_ = sums_.hessian;
    const auto resisting = order == Order::hessian ? RigidMotions::Resisting::supports_and_loads
                                                   : RigidMotions::Resisting::supports;
    for (const GaugeDirection& gauge : rigid_.gauge(x_, resisting)) {
        const int at = pattern.block_offset(gauge.vertex, gauge.vertex);
        const int length = pattern.column_length(gauge.vertex);
        const double stiffness =
            (matrix_[at] + matrix_[at + length + 1] + matrix_[at + 2 * length + 2]) / 3.0;
        for (int c = 0; c < 3; ++c) {
            for (int r = 0; r < 3; ++r) {
                matrix_[at + c * length + r] += stiffness * gauge.direction[r] * gauge.direction[c];
            }
        }
    }
    const std::vector<int>& start = pattern.column_start();
    const std::vector<int>& row = pattern.row_index();
    const bool supported = !model().input().supports.empty();
    for (int column = 0; column < model().size() && (supported || shift != 0.0); ++column) {
        for (int k = start[column]; k < start[column + 1]; ++k) {
            if (row[k] == column) matrix_[k] += shift;
            if (held_[column] || held_[row[k]]) matrix_[k] = row[k] == column ? 1.0 : 0.0;
        }
    }
}

bool Newton::factorize(Order order, double shift) {
    build_matrix(order, shift);
    ++factorizations_;
    const bool definite = cholesky_.factorize(matrix_);
    factor_is_near_ = definite && order == Order::hessian && shift == 0.0;
    return definite;
}

/// Solves for the step with the exact Hessian by conjugate gradients, preconditioned with the last factor.
/// False when that would take long or the Hessian is not positive definite.
bool Newton::solve_with_last_factor() {
    constexpr double accuracy = 1e-3;  // of the residual
    constexpr int most_steps = 10;
    build_matrix(Order::hessian, 0.0);
    const Eigen::Map<const Eigen::SparseMatrix<double>> matrix(
        model().size(), model().size(), static_cast<Eigen::Index>(matrix_.size()),
        model().pattern().column_start().data(), model().pattern().row_index().data(), matrix_.data());
    Eigen::VectorXd rest = -sums_.gradient;
    const double enough = accuracy * rest.norm();
    Eigen::VectorXd direction = cholesky_.solve(rest);
    double product = rest.dot(direction);
    step_.setZero(model().size());
    for (int i = 0; i < most_steps; ++i) {
        const Eigen::VectorXd pull = matrix.selfadjointView<Eigen::Lower>() * direction;
        const double curvature = direction.dot(pull);
        if (!(curvature > 0.0)) return false;
        step_ += (product / curvature) * direction;
        rest -= (product / curvature) * pull;
        if (rest.norm() < enough) return true;
        const Eigen::VectorXd next = cholesky_.solve(rest);
        const double next_product = rest.dot(next);
        direction = next + (next_product / product) * direction;
        product = next_product;
    }
    return false;
}

/// Factorises and solves for the step. Where the exact Hessian is not positive definite a sheet that nothing
/// holds falls back on the Gauss-Newton form, whose lack of geometric stiffness the retraction makes up for.
/// In one that supports or loads hold that stiffness is what resists (a pendulum has no other): there a
/// multiple of the identity is added, little more than it takes. False when no matrix could be factorised.
bool Newton::solve_step(Order order) {
    constexpr double near = 0.03;  // rad
    if (order == Order::hessian && factor_is_near_ && rotation_ < near && solve_with_last_factor())
        return true;
    bool ready = factorize(order);
    const double mean = ready ? 0.0 : mean_stiffness();
    if (!ready && exact_first()) {
        for (shift_ = std::max(0.1 * shift_, 1e-9 * mean); !ready && shift_ < 1e3 * mean; shift_ *= 4.0)
            ready = factorize(order, shift_);
    } else if (!ready) {
        if (order == Order::hessian) {
            evaluate(Order::gauss_newton);
            ready = factorize(Order::gauss_newton);
        }
        for (double shift = 1e-9 * mean; !ready && shift < 1e3 * mean; shift *= 100.0)
            ready = factorize(Order::gauss_newton, shift);
    }
    if (ready) step_ = cholesky_.solve(-sums_.gradient);
    return ready && step_.allFinite();
}

/// Armijo's rule along the retraction; false when no step of reasonable length lowers energy or residual.
bool Newton::line_search() {
    const double energy = terms_.total();
    const double slope = sums_.gradient.dot(step_);
    const double before = residual();
    double t = std::min(1.0, largest_turn() / rotation_);
    for (int halving = 0; halving < 30; ++halving, t *= 0.5) {
        const Eigen::VectorXd candidate = retraction_(x_, step_, t);
        if (!may_take(candidate)) continue;
        if (std::abs(slope) < 1e-9 * energy_scale()) {
            // Energy differences drown in rounding: judge by the gradient.
            const EnergyTerms terms = evaluate(candidate, Order::gradient, trial_);
            if (std::isfinite(terms.total()) && trial_.gradient.cwiseAbs().maxCoeff() < before) {
                x_ = candidate;
                return true;
            }
            if (std::abs(slope) < 1e-13 * energy_scale() && halving > 3) return false;
        }
        const double trial = model().energy(candidate);
        if (std::isfinite(trial) && trial <= energy + 1e-4 * t * slope) {
            x_ = candidate;
            return true;
        }
    }
    return false;
}

/// Nonlinear elimination after a step, unless Newton's method converges well without it.
void Newton::relax_spots() {
    constexpr double converging = 0.01;
    const double before = residual();
    evaluate(x_, Order::gradient, trial_);
    if (!(trial_.gradient.cwiseAbs().maxCoeff() > converging * before)) return;
    const Eigen::VectorXd from = x_;
    elimination_(model(), x_, trial_.gradient);
    if (!may_take(x_)) x_ = from;
}

/// Whether the residual no longer falls because it is the rounding of the unknowns. `sums_` has the Hessian.
bool Newton::drowns_in_rounding(double last_residual) const {
    return residual() > 0.5 * last_residual &&
           residual_beyond_rounding(model().pattern(), sums_, x_) <= options_.residual_tolerance_n;
}

/// At a stationary point whose exact Hessian is indefinite: finds the most negative direction by inverse
/// iteration on a shifted matrix and moves along it to lower energy.
bool Newton::leave_saddle() {
    const double mean = mean_stiffness();
    bool ready = false;
    for (double shift = 1e-8 * mean; !ready && shift < 1e3 * mean; shift *= 10.0)
        ready = factorize(Order::hessian, shift);
    if (!ready) return false;
    Eigen::VectorXd direction(model().size());
    for (int i = 0; i < model().size(); ++i) direction[i] = held_[i] ? 0.0 : noise(options_.seed + 77, i);
    for (int i = 0; i < 20; ++i) direction = cholesky_.solve(direction.normalized()).col(0);
    direction /= direction.head(3 * model().vertex_count()).cwiseAbs().maxCoeff();
    if (direction.dot(sums_.gradient) > 0.0) direction = -direction;
    const double energy = terms_.total();
    double best_energy = energy - 1e-14 * energy_scale();
    Eigen::VectorXd best;
    for (double length = 4.0; length > 1e-4; length *= 0.5) {
        for (const double sign : {1.0, -1.0}) {
            const Eigen::VectorXd candidate = retraction_(x_, direction, sign * length);
            const double trial = model().energy(candidate);
            if (std::isfinite(trial) && trial < best_energy && may_take(candidate)) {
                best_energy = trial;
                best = candidate;
            }
        }
        if (best.size() > 0) break;
    }
    if (best.size() == 0) return false;
    x_ = best;
    return true;
}

void Newton::report() const {
    control_.say({"release", -1.0,
                  "iteration " + std::to_string(iterations_) + ": energy " + std::to_string(terms_.total()) +
                      " mJ, residual " + short_number(residual()) + " N"});
}

Equilibrium Newton::run(const Eigen::VectorXd& start) {
    x_ = retraction_.meet_supports(start);
    Equilibrium result;
    result.residual = infinity;
    rotation_ = infinity;
    factor_is_near_ = false;
    const int first_iteration = iterations_;
    int gauss_newton_left = 0;
    int escapes = 0;
    bool stalled = false;
    for (;;) {
        const bool exact = exact_first() || (rotation_ <= turning && gauss_newton_left == 0);
        const Order order = exact ? Order::hessian : Order::gauss_newton;
        evaluate(order);
        constexpr double settled = 0.02;  // rad: what leans on the extension now will do so in the end
        if ((rotation_ < settled || residual() <= options_.residual_tolerance_n) && narrow_extension())
            evaluate(order);
        report();
        if (is_good(x_)) last_good_ = x_;
        const double last_residual = std::exchange(result.residual, residual());
        if (!std::isfinite(terms_.total()) || !std::isfinite(result.residual)) {
            result.message = "the start is not a possible shape: its energy is not finite";
            break;
        }
        const bool drowned = exact && drowns_in_rounding(last_residual);
        if (result.residual <= options_.residual_tolerance_n || stalled || drowned) {
            if (!exact) evaluate(Order::hessian);
            result.stable = factorize(Order::hessian);
            if (result.stable || escapes == 5) {
                const bool as_wanted = result.residual <= options_.residual_tolerance_n;
                const bool converged = as_wanted || drowned || drowns_in_rounding(0.0);
                result.status = converged ? SolveStatus::converged : SolveStatus::not_converged;
                result.message = result.stable ? "strict local minimum" : "stationary, but not a minimum";
                if (converged && !as_wanted)
                    result.message += "; the residual is the rounding of coordinates at very small elements";
                if (!converged) result.message = "no step lowers energy or residual any further";
                break;
            }
            ++escapes;
            stalled = false;
            if (!leave_saddle()) {
                result.message = "a saddle that could not be left";
                break;
            }
            rotation_ = turning;
            continue;
        }
        if (rotation_ < options_.enough_rotation) {
            result.message = "close enough for a start";
            break;
        }
        if (iterations_ - first_iteration >= options_.max_iterations) {
            result.message = "not converged after " + std::to_string(options_.max_iterations) + " iterations";
            break;
        }
        if (control_.stopped()) {
            result.status = SolveStatus::interrupted;
            result.message = "interrupted";
            break;
        }
        ++iterations_;
        const int before = factorizations_;
        if (!solve_step(order)) {
            result.message = "no factorisable matrix at iteration " + std::to_string(iterations_);
            break;
        }
        if (gauss_newton_left > 0) --gauss_newton_left;
        if (exact && factorizations_ > before + 1) gauss_newton_left = 1;
        rotation_ = retraction_.rms_rotation(x_, step_);
        stalled = !line_search();
        if (stalled && !exact) {
            // Try the exact Hessian before giving up.
            rotation_ = 0.0;
            gauss_newton_left = 0;
            stalled = false;
            evaluate(Order::hessian);
            stalled = !(solve_step(Order::hessian) && line_search());
        }
        if (!stalled) relax_spots();
    }
    result.x = x_;
    result.energy = terms_;
    result.typical_force = model().typical_force(x_);
    result.iterations = iterations_;
    result.factorizations = factorizations_;
    result.health = model().health(x_);
    result.health.tangled = !tangle(result.health).empty();
    result.log_extension = model().input().options.log_extension;
    return result;
}

}  // namespace

template <class Start>
static Equilibrium timed_solve(const Model& model, const SolveOptions& options, const Control& control,
                               const Start& start) {
    const auto begin = std::chrono::steady_clock::now();
    require_held(model);
    set_blas_threads(options.deterministic ? 1 : thread_count());
    Newton newton(model, options, control);
    const Reruns reruns{
        .run = [&](const Eigen::VectorXd& from) { return newton.run(from); },
        .last_good = [&] { return newton.last_good(); },
        .be_wary = [&] { newton.be_wary(); },
        .flat = [&] { return noisy_start(model, options.seed + Reruns::other_noise, options.noise_mm); },
        .rough = options.enough_rotation > 0.0};
    Equilibrium result = solve_around_tangles(start(newton), reruns, control);
    result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    result.levels = {{.triangles = model.input().mesh.triangle_count(),
                      .iterations = result.iterations,
                      .factorizations = result.factorizations}};
    return result;
}

Equilibrium solve(const Model& model, const SolveOptions& options, const Control& control,
                  const Eigen::VectorXd* start) {
    return timed_solve(model, options, control, [&](Newton&) {
        return start != nullptr ? *start : noisy_start(model, options.seed, options.noise_mm);
    });
}

Equilibrium solve(const Model& model, const SolveOptions& options, const Control& control,
                  const LayoutShape& start) {
    return timed_solve(model, options, control, [&](Newton& newton) { return newton.carried_over(start); });
}

}  // namespace ruche
