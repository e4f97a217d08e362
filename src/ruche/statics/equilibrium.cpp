#include "ruche/statics/equilibrium.hpp"

#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <new>
#include <optional>

#include "ruche/core/error.hpp"
#include "ruche/core/memory.hpp"
#include "ruche/core/parallel.hpp"
#include "ruche/statics/contact_guard.hpp"
#include "ruche/statics/nonlinear_elimination.hpp"
#include "ruche/statics/retraction.hpp"
#include "ruche/statics/rigid_motions.hpp"
#include "ruche/statics/sparse_cholesky.hpp"

namespace ruche {
namespace {

/// Reproducible noise: a number in [-1, 1] from a seed and an index (SplitMix64).
double noise(std::uint64_t seed, std::uint64_t index) {
    std::uint64_t z = (seed << 40U) + (index + 1) * 0x9e3779b97f4a7c15ULL;
    z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27U)) * 0x94d049bb133111ebULL;
    z ^= z >> 31U;
    return static_cast<double>(z >> 11U) * 0x1.0p-52 - 1.0;
}

double smallest_edge(const TriangleMesh& mesh) {
    double smallest = infinity;
    for (const Triangle& tri : mesh.triangles) {
        for (int i = 0; i < 3; ++i) {
            smallest = std::min(smallest, (mesh.vertices[tri[i]] - mesh.vertices[tri[(i + 1) % 3]]).norm());
        }
    }
    return smallest;
}

Eigen::VectorXd noisy_start(const Model& model, const SolveOptions& options) {
    Eigen::VectorXd x = model.initial();
    const double size = std::min(options.noise_mm, 0.01 * smallest_edge(model.input().mesh));
    for (int i = 0; i < 3 * model.vertex_count(); ++i) x[i] += size * noise(options.seed, i);
    return x;
}

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
        if (model.input().options.contact) {
            own_.emplace(model.input());
            contact_.emplace(model);
        }
    }

    /// Tells how large the system of equations is.
    void announce() const;
    Equilibrium run(const Eigen::VectorXd& start);
    Equilibrium run(const LayoutShape& start) { return run(transfer(start, model(), retraction_)); }

  private:
    /// rms rotation of a step above which the sheet is "turning" and the Gauss-Newton form is the better
    /// model.
    static constexpr double turning = 0.05;

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
               std::abs(terms_.gravity) + std::abs(terms_.contact);
    }

    /// The Gauss-Newton form's share in the matrix where the exact Hessian is not positive definite: what it
    /// begins with, and the factor by which it grows and falls.
    static constexpr double first_blend = 0.1;
    static constexpr double blend_factor = 4.0;

    void iterate(Equilibrium& result);
    bool narrow_extension();
    ClearPath follow(const Eigen::VectorXd& direction, double length);
    void cover_contacts(const Eigen::VectorXd& x);
    void build_matrix(Order order, double shift);
    bool factorize(Order order, double shift = 0.0);
    bool factorize_blend();
    void adapt_blend();
    bool solve_with_last_factor();
    bool solve_step(Order order);
    bool line_search();
    bool at_rounding_limit() const;
    std::string missing_memory() const;
    void relax_spots();
    bool leave_saddle();
    void report() const;

    const Model& model() const { return own_ ? *own_ : *original_; }

    const Model* original_;
    std::optional<Model> own_;  // the same sheet with the narrower extension of the law, or with contacts
    std::optional<ContactGuard> contact_;
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
    bool pattern_is_new_ = false;  // since the last factorisation
    double shift_ = 0.0;           // of the last indefinite Hessian, N/mm
    double blend_ = 0.0;           // share of the Gauss-Newton form in the matrix
    double step_length_ = 1.0;     // of the last line search; 1 = Newton's step
    bool factor_is_near_ = false;  // the last factor is of an exact Hessian
    double rotation_ = infinity;   // rms of the last step
    int iterations_ = 0;
    int factorizations_ = 0;
};

/// Exchanges the model for one with a narrower linear extension when the shape leans on it.
bool Newton::narrow_extension() {
    const double narrow = options_.narrow_log_extension;
    if (narrow == 0.0 || narrow >= model().input().options.log_extension ||
        model().elements_beyond_law(x_) == 0) {
        return false;
    }
    ModelInput input = model().input();
    input.options.log_extension = narrow;
    std::vector<ContactPair> contacts = model().contacts();
    own_.emplace(std::move(input));
    if (contact_) own_->set_contacts(std::move(contacts));
    return true;
}

/// The curve from the present state along a direction, `length` of it, as far as the way is clear.
ClearPath Newton::follow(const Eigen::VectorXd& direction, double length) {
    const StateCurve curve = [this, &direction, length](double t) {
        return retraction_(x_, direction, t * length);
    };
    if (!contact_) return ClearPath(curve);
    return contact_->follow(x_, curve, std::abs(length) * retraction_.rms_rotation(x_, direction));
}

/// Before an energy at `x` is asked for: the model must know what touches there, and still at the present
/// state.
void Newton::cover_contacts(const Eigen::VectorXd& x) {
    if (contact_ && contact_->cover(*own_, x_, x)) pattern_is_new_ = true;
}

void Newton::build_matrix(Order order, double shift) {
    const NodePattern& pattern = model().pattern();
    matrix_ = sums_.hessian;
    const auto resisting = order == Order::hessian ? RigidMotions::Resisting::supports_and_loads
                                                   : RigidMotions::Resisting::supports;
    rigid_.hold(pattern, x_, resisting, matrix_);
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
    if (pattern_is_new_) {
        vertex_order_ = vertex_elimination_order(model().pattern());
        cholesky_ =
            SparseCholesky({model().size(), model().pattern().column_start(), model().pattern().row_index()},
                           elimination_order(model(), vertex_order_));
        pattern_is_new_ = false;
    }
    ++factorizations_;
    const bool definite = cholesky_.factorize(matrix_);
    factor_is_near_ = definite && order == Order::hessian && shift == 0.0;
    return definite;
}

/// Solves for the step with the exact Hessian by conjugate gradients, preconditioned with the last factor.
/// False when that would take long or the Hessian is not positive definite.
bool Newton::solve_with_last_factor() {
    constexpr double accuracy = 1e-3;  // of the residual
    constexpr int most_steps = 4;
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

/// The exact Hessian, or where that is not positive definite (fabric about to buckle) a mean of it and the
/// Gauss-Newton form, whose share is kept from step to step. On its own the latter knows nothing of the
/// compression that makes fabric buckle, and a barely definite matrix runs far along the buckling shapes.
bool Newton::factorize_blend() {
    if (blend_ == 0.0 && factorize(Order::hessian)) return true;
    model().evaluate(x_, Order::gauss_newton, trial_);
    const std::vector<double> exact = sums_.hessian;
    bool ready = false;
    for (blend_ = std::max(blend_, first_blend); !ready;) {
        for (std::size_t i = 0; i < exact.size(); ++i)
            sums_.hessian[i] = (1.0 - blend_) * exact[i] + blend_ * trial_.hessian[i];
        ready = factorize(Order::gauss_newton);
        if (blend_ == 1.0) break;
        if (!ready) blend_ = std::min(1.0, blend_factor * blend_);
    }
    return ready;
}

/// More of the Gauss-Newton form after a step that was too long, less after one that was not.
void Newton::adapt_blend() {
    if (step_length_ < 1.0) {
        blend_ = std::clamp(blend_factor * blend_, 0.5 * first_blend, 1.0);
    } else {
        blend_ /= blend_factor;
        if (blend_ < 0.3 * first_blend) blend_ = 0.0;
    }
}

/// Factorises and solves for the step. In a sheet that supports or loads hold, geometric stiffness is what
/// resists (a pendulum has no other), and the Gauss-Newton form lacks it: there a multiple of the identity is
/// added, little more than it takes. False when no matrix could be factorised.
bool Newton::solve_step(Order order) {
    constexpr double near = 0.03;  // rad
    if (order == Order::hessian && factor_is_near_ && rotation_ < near && solve_with_last_factor())
        return true;
    bool ready = order == Order::hessian && !loaded_ ? factorize_blend() : factorize(order);
    const double mean = ready ? 0.0 : mean_stiffness();
    if (!ready && loaded_) {
        for (shift_ = std::max(0.1 * shift_, 1e-9 * mean); !ready && shift_ < 1e3 * mean; shift_ *= 4.0)
            ready = factorize(order, shift_);
    } else {
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
    const ClearPath path = follow(step_, 1.0);
    step_length_ = path.end();
    for (int halving = 0; halving < 30; ++halving, step_length_ *= 0.5) {
        const double t = step_length_;
        const Eigen::VectorXd candidate = path.at(t);
        cover_contacts(candidate);
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

/// Whether every component of the gradient is at rest or below what the last digits of the positions decide,
/// sum_j |H_ij| |x_j| eps: where fabric leans on the steep end of its law that may be above the tolerance.
/// Asks for the exact Hessian in the sums.
bool Newton::at_rounding_limit() const {
    const std::vector<int>& start = model().pattern().column_start();
    const std::vector<int>& row = model().pattern().row_index();
    Eigen::VectorXd limit = Eigen::VectorXd::Zero(model().size());
    for (int column = 0; column < model().size(); ++column) {
        for (int k = start[column]; k < start[column + 1]; ++k) {
            if (row[k] < column) continue;
            const double stiffness = std::abs(sums_.hessian[k]);
            limit[row[k]] += stiffness * std::abs(x_[column]);
            if (row[k] != column) limit[column] += stiffness * std::abs(x_[row[k]]);
        }
    }
    limit *= std::numeric_limits<double>::epsilon();
    return (sums_.gradient.cwiseAbs().array() <= limit.array().max(options_.residual_tolerance_n)).all();
}

/// Nonlinear elimination after a step, unless Newton's method converges well without it.
void Newton::relax_spots() {
    constexpr double converging = 0.01;
    const double before = residual();
    evaluate(x_, Order::gradient, trial_);
    if (!(trial_.gradient.cwiseAbs().maxCoeff() > converging * before)) return;
    const Eigen::VectorXd from = x_;
    elimination_(model(), x_, trial_.gradient);
    if (!contact_) return;
    // It knows of no obstacles but those that are near already.
    if (!contact_->clear(from, x_)) x_ = from;
    cover_contacts(x_);
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
            const ClearPath path = follow(direction, sign * length);
            const Eigen::VectorXd candidate = path.at(path.end());
            cover_contacts(candidate);
            const double trial = model().energy(candidate);
            if (std::isfinite(trial) && trial < best_energy) {
                best_energy = trial;
                best = candidate;
            }
        }
        if (best.size() > 0) break;
    }
    if (best.size() == 0) return false;
    x_ = best;
    cover_contacts(x_);
    return true;
}

void Newton::report() const {
    control_.say({"release", -1.0,
                  "iteration " + std::to_string(iterations_) + ": energy " + std::to_string(terms_.total()) +
                      " mJ, residual " + short_number(residual()) + " N"});
}

void Newton::announce() const {
    control_.say({"release", -1.0,
                  std::to_string(model().input().mesh.triangle_count()) + " triangles, " +
                      std::to_string(model().size()) + " unknowns, factor of " +
                      std::to_string(std::lround(cholesky_.factor_megabytes())) + " MB"});
}

/// Says so when the factor and the matrices that go with it do not fit into memory; else empty.
std::string Newton::missing_memory() const {
    constexpr double megabyte = 1e6;
    constexpr double matrices = 4.0;  // exact, Gauss-Newton, a copy of each with the rigid motions removed
    const double needed =
        1.05 * cholesky_.factor_megabytes() +
        matrices * sizeof(double) * static_cast<double>(model().pattern().row_index().size()) / megabyte;
    double available = static_cast<double>(memory_available()) / megabyte;
    if (options_.memory_limit_mb > 0.0)
        available =
            std::min(available, options_.memory_limit_mb - static_cast<double>(memory_in_use()) / megabyte);
    if (needed <= available) return {};
    char text[160];
    std::snprintf(
        text, sizeof text,
        "not enough memory for this mesh: the factorisation needs %.0f MB more, %.0f MB are available",
        needed, std::max(0.0, available));
    return text;
}

Equilibrium Newton::run(const Eigen::VectorXd& start) {
    x_ = retraction_.meet_supports(start);
    Equilibrium result;
    result.message = missing_memory();
    try {
        if (result.message.empty()) {
            iterate(result);
        } else {
            terms_ = model().energy_terms(x_);
        }
    } catch (const std::bad_alloc&) {
        result.message = "out of memory after " + std::to_string(iterations_) + " iterations";
    }
    result.x = x_;
    result.energy = terms_;
    result.typical_force = model().typical_force(x_);
    result.iterations = iterations_;
    result.factorizations = factorizations_;
    result.health = model().health(x_);
    result.log_extension = model().input().options.log_extension;
    return result;
}

void Newton::iterate(Equilibrium& result) {
    int escapes = 0;
    bool stalled = false;
    cover_contacts(x_);
    const bool impossible = contact_ && passes_through_itself(model(), x_);
    for (;;) {
        const bool exact = loaded_ || rotation_ <= turning;
        const Order order = exact ? Order::hessian : Order::gauss_newton;
        evaluate(order);
        constexpr double settled = 0.02;  // rad: what leans on the extension now will do so in the end
        if ((rotation_ < settled || residual() <= options_.residual_tolerance_n) && narrow_extension())
            evaluate(order);
        report();
        result.residual = residual();
        if (!std::isfinite(terms_.total()) || !std::isfinite(result.residual)) {
            result.message = "the start is not a possible shape: its energy is not finite";
            break;
        }
        if (impossible) {
            result.message = "the start passes through itself: contact cannot undo that";
            break;
        }
        const bool at_rest = result.residual <= options_.residual_tolerance_n;
        const bool rounded = !at_rest && exact && at_rounding_limit();
        if (at_rest || rounded || stalled) {
            if (!exact) evaluate(Order::hessian);
            result.stable = factorize(Order::hessian);
            if (result.stable || escapes == 5) {
                result.status = at_rest || rounded ? SolveStatus::converged : SolveStatus::not_converged;
                result.message = result.stable ? "strict local minimum" : "stationary, but not a minimum";
                if (rounded) result.message += ", to the last digits of the positions";
                if (stalled && !rounded) result.message = "no step lowers energy or residual any further";
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
        if (iterations_ >= options_.max_iterations) {
            result.message = "not converged after " + std::to_string(iterations_) + " iterations";
            break;
        }
        if (control_.timed_out()) {
            result.message =
                "the time limit was reached after " + std::to_string(iterations_) + " iterations";
            break;
        }
        if (control_.stopped()) {
            result.status = SolveStatus::interrupted;
            result.message = "interrupted";
            break;
        }
        ++iterations_;
        if (!solve_step(order)) {
            result.message = "no factorisable matrix at iteration " + std::to_string(iterations_);
            break;
        }
        rotation_ = retraction_.rms_rotation(x_, step_);
        stalled = !line_search();
        if (stalled && !exact) {
            // Try the exact Hessian before giving up.
            rotation_ = 0.0;
            stalled = false;
            evaluate(Order::hessian);
            stalled = !(solve_step(Order::hessian) && line_search());
        }
        if (exact) adapt_blend();
        if (!stalled) relax_spots();
    }
}

void require_held(const Model& model) {
    const ModelInput& input = model.input();
    const Vec3 gravity(input.gravity[0], input.gravity[1], input.gravity[2]);
    if (gravity.norm() == 0.0 || input.table.present) return;
    const MeshPieces pieces = find_pieces(input.mesh);
    std::vector<char> held(pieces.count, 0);
    for (const Support& support : input.supports) {
        if (pieces.of_vertex[support.vertex] >= 0) held[pieces.of_vertex[support.vertex]] = 1;
    }
    for (const char h : held) {
        if (!h) {
            throw InputError(
                {.key = "gravity"}, "a piece of the sheet would fall for ever: nothing holds it",
                "Add a [[support]], put it on a table (gravity.table = true), or remove gravity.");
        }
    }
}

}  // namespace

template <class Start>
static Equilibrium timed_solve(const Model& model, const SolveOptions& options, const Control& control,
                               const Start& start) {
    const auto begin = std::chrono::steady_clock::now();
    require_held(model);
    Newton newton(model, options, control);
    newton.announce();
    Equilibrium result = newton.run(start);
    result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    result.levels = {{.triangles = model.input().mesh.triangle_count(),
                      .iterations = result.iterations,
                      .factorizations = result.factorizations}};
    return result;
}

Equilibrium solve(const Model& model, const SolveOptions& options, const Control& control,
                  const Eigen::VectorXd* start) {
    return timed_solve(model, options, control, start != nullptr ? *start : noisy_start(model, options));
}

Equilibrium solve(const Model& model, const SolveOptions& options, const Control& control,
                  const LayoutShape& start) {
    return timed_solve(model, options, control, start);
}

}  // namespace ruche
