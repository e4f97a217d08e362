#include "ruche/statics/newton.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <new>
#include <utility>

#include "ruche/statics/bending_places.hpp"
#include "ruche/statics/fabric_relaxation.hpp"
#include "ruche/statics/iterate.hpp"
#include "ruche/statics/smoothing.hpp"
#include "ruche/statics/starts.hpp"
#include "ruche/statics/tangle.hpp"

namespace ruche {

/// Largest component of the gradient, N.
static double largest(const AssembledSums& sums) { return sums.gradient.cwiseAbs().maxCoeff(); }

Newton::Newton(const Model& model, const SolveOptions& options, const Control& control)
    : Newton(model, held_unknowns(model), is_loaded(model.input()), options, control,
             vertex_elimination_order(model.pattern())) {}

Newton::Newton(const SheetPiece& piece, bool loaded, const SolveOptions& options, const Control& control)
    : Newton(piece.model, piece.held, loaded, options, control,
             vertex_elimination_order(piece.model.pattern())) {
    settles_places_ = false;
}

Newton::Newton(const Model& model, std::vector<char> held, bool loaded, const SolveOptions& options,
               const Control& control, const std::vector<int>& vertex_order)
    : original_(&model),
      options_(options),
      control_(control),
      held_(std::move(held)),
      loaded_(loaded),
      vertex_order_(vertex_order),
      retraction_(model, vertex_order),
      system_(model, held_, loaded, vertex_order),
      elimination_(model, held_) {
    settles_places_ = model.input().rods.empty() && !model.input().options.contact;
    if (model.input().options.contact) {
        own_.emplace(model.input());
        contact_.emplace(model);
    }
}

/// As the model does, with the supports' reactions taken out of the gradient.
EnergyTerms Newton::evaluate(const Eigen::VectorXd& x, Order order, AssembledSums& sums) const {
    const EnergyTerms terms = model().evaluate(x, order, sums);
    for (int i = 0; i < model().size(); ++i) {
        if (held_[i]) sums.gradient[i] = 0.0;
    }
    return terms;
}

/// At the present state, unless the line search has done so already.
void Newton::evaluate(Order order) {
    if (order == trial_order_ && trial_at_.size() > 0 && trial_at_ == x_) {
        std::swap(sums_, trial_);
        terms_ = trial_terms_;
    } else {
        terms_ = evaluate(x_, order, sums_);
    }
    order_ = order;
    trial_at_.resize(0);
}

bool Newton::is_good(const Eigen::VectorXd& x) const { return tangle(model().health(x)).empty(); }

double Newton::largest_turn() const {
    return wary_ ? std::min(wary_turn, options_.largest_turn) : options_.largest_turn;
}

/// Exchanges the model for one with a narrower linear extension when the shape leans on it, and brings the
/// spots that do into equilibrium with it.
bool Newton::narrow_extension() {
    const double narrow = options_.narrow_log_extension;
    if (narrow == 0.0 || narrow >= model().input().options.log_extension ||
        model().elements_beyond_law(x_) == 0) {
        return false;
    }
    own_.emplace(model().with_log_extension(narrow));
    trial_at_.resize(0);
    relax_while(x_, 1e-9);
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
    if (!contact_ || !contact_->cover(*own_, x_, x)) return;
    system_.change_pattern();
    trial_at_.resize(0);
}

/// Armijo's rule along the retraction; false when no step of reasonable length lowers energy or residual.
/// `trial_` then has the gradient where it ended, and the Hessian too if that is `wanted_next` and the whole
/// step was taken.
bool Newton::line_search(Order wanted_next) {
    const double energy = terms_.total();
    const double slope = sums_.gradient.dot(step_);
    const double before = residual();
    const ClearPath path = follow(step_, 1.0);
    double t = std::min(path.end(), largest_turn() / rotation_);
    halved_ = false;
    // A wary solve rather takes a shorter step than one into a tangle. Not at any price: tiny elements fold
    // for a while and unfold again, and a wall there would hold up the whole sheet.
    constexpr int wary_halvings = 4;
    for (int halving = 0; halving < 30; ++halving, t *= 0.5, halved_ = true) {
        Eigen::VectorXd candidate = path.at(t);
        cover_contacts(candidate);
        if (halving < wary_halvings && !may_take(candidate)) continue;
        // The first candidate is taken nearly always, and what comes after a step wants the gradient.
        const bool with_gradient = halving == 0 || std::abs(slope) < 1e-9 * terms_.scale();
        const Order order = halving == 0 ? wanted_next : Order::gradient;
        if (with_gradient) trial_terms_ = evaluate(candidate, order, trial_);
        double trial = with_gradient ? trial_terms_.total() : model().energy(candidate);
        const auto is_lower = [&] { return std::isfinite(trial) && trial <= energy + 1e-4 * t * slope; };
        bool lower = is_lower();
        if (std::abs(slope) < 1e-9 * terms_.scale()) {
            // Energy differences drown in rounding: judge by the gradient.
            lower |= std::isfinite(trial) && largest(trial_) < before;
            if (!lower && std::abs(slope) < 1e-13 * terms_.scale() && halving > 3) return false;
        }
        if (lower && order.wants_hessian()) {
            trial_at_ = candidate;
            trial_order_ = order;
        }
        if (!lower && halving == 0 && std::isfinite(trial) && !contact_) {
            // A few spots that it has thrown far off must not shorten the step of the whole sheet.
            trial -= elimination_.after_step(model(), x_, before, candidate, trial_.gradient);
            lower = is_lower() && may_take(candidate);
            if (!lower && !places_.empty()) {
                // Nor a few places that come to rest after it anyway.
                settle_places(candidate);
                trial_terms_ = evaluate(candidate, Order::gradient, trial_);
                trial = trial_terms_.total();
                lower = is_lower() && may_take(candidate);
                if (lower) places_.clear();
            }
        }
        if (lower) {
            x_ = candidate;
            if (!with_gradient) evaluate(x_, Order::gradient, trial_);
            return true;
        }
    }
    return false;
}

/// Nonlinear elimination after a step, unless Newton's method converges well without it or has converged.
/// `trial_` has the gradient.
void Newton::relax_spots() {
    constexpr double converging = 0.01;
    constexpr int most_sweeps = 2;
    // While the sheet turns, spots with their neighbours go to shapes of their own that fit no other part.
    const int rings = rotation_ <= turning ? 1 : 0;
    const double enough = std::max(converging * residual(), options_.residual_tolerance_n);
    for (int sweep = 0; sweep < most_sweeps && largest(trial_) > enough; ++sweep) {
        const Eigen::VectorXd from = x_;
        trial_at_.resize(0);
        elimination_(model(), x_, trial_.gradient, rings);
        // It knows neither of tangles nor of obstacles that are not near already.
        if ((!may_take(x_) && is_good(from)) || (contact_ && !contact_->clear(from, x_))) {
            x_ = from;
            break;
        }
        cover_contacts(x_);
    }
}

/// Takes short waves out before the first exact Hessian: the compression that the Gauss-Newton form leaves
/// behind in single elements makes that one indefinite, or so nearly so that its step is lost along soft
/// shapes. Where that cannot be done, the exact Hessian is expected to be indefinite.
void Newton::smooth() {
    const double turned = rotation_;
    places_.clear();
    evaluate(Order::hessian);
    step_ = smoothing_step(model().pattern(), held_, sums_.hessian, sums_.gradient, smoothing_sweeps);
    rotation_ = retraction_.rms_rotation(x_, step_);
    // What turns the sheet is no short wave. Where no part of it lowers the energy, Newton's method goes on
    // from here as well.
    const bool short_waves = rotation_ > 0.0 && rotation_ <= turning && step_.allFinite();
    if (!short_waves || !line_search(Order::hessian)) system_.expect_indefinite();
    rotation_ = turned;
}

/// Where the last step has bent the sheet in a few places only, those come to rest on their own, all else
/// held, unless the forces on them, which `trial_` has, are small beside others.
void Newton::settle_places(Eigen::VectorXd& x) {
    constexpr double worth_it = 0.1;
    try {
        for (const std::vector<int>& place : places_) {
            if (control_.stopped() || control_.timed_out()) return;
            double force = 0.0;
            for (const int v : place)
                force =
                    std::max(force, trial_.gradient.segment<3>(3 * Eigen::Index{v}).cwiseAbs().maxCoeff());
            if (force < worth_it * largest(trial_)) continue;
            const SheetPiece piece = cut_out(model(), place, x);
            piece.place(Newton(piece, loaded_, options_, control_).settle(piece.take(x)), x);
        }
    } catch (const std::bad_alloc&) {
        // It is not needed.
    }
}

Eigen::VectorXd Newton::settle(const Eigen::VectorXd& start) {
    constexpr int most_steps = 10;
    constexpr double settled = 1e-3;  // rad
    x_ = start;
    if (!system_.missing_memory(model(), options_.memory_limit_mb).empty()) return x_;
    for (rotation_ = turning; rotation_ > settled && iterations_ < most_steps; ++iterations_) {
        evaluate(system_.wanted(rotation_));
        if (residual() <= options_.residual_tolerance_n || control_.stopped() || control_.timed_out() ||
            !step(true))
            break;
        relax_spots();
    }
    return x_;
}

/// At a stationary point whose exact Hessian is indefinite: moves to lower energy along the direction of most
/// negative curvature.
bool Newton::leave_saddle() {
    Eigen::VectorXd direction(model().size());
    for (int i = 0; i < model().size(); ++i) direction[i] = held_[i] ? 0.0 : noise(options_.seed + 77, i);
    if (!system_.steepest_curvature(here(), direction)) return false;
    direction /= direction.head(3 * model().vertex_count()).cwiseAbs().maxCoeff();
    if (direction.dot(sums_.gradient) > 0.0) direction = -direction;
    const double energy = terms_.total();
    double best_energy = energy - 1e-14 * terms_.scale();
    Eigen::VectorXd best;
    for (double length = 4.0; length > 1e-4; length *= 0.5) {
        for (const double sign : {1.0, -1.0}) {
            const ClearPath path = follow(direction, sign * length);
            const Eigen::VectorXd candidate = path.at(path.end());
            cover_contacts(candidate);
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
    cover_contacts(x_);
    return true;
}

void Newton::report() const {
    control_.say({"release", -1.0,
                  fmt::format("iteration {}: energy {:.6f} mJ, residual {:.1e} N, last turn {:.1e} rad, {} "
                              "factorisations",
                              iterations_, terms_.total(), residual(), rotation_, system_.factorizations())});
    if (control_.watch)
        control_.watch({.sheet = model().input(),
                        .x = x_,
                        .iteration = iterations_,
                        .energy = terms_.total(),
                        .residual = residual()});
}

void Newton::announce() const {
    control_.say(
        {"release", -1.0,
         fmt::format("{} triangles, {} unknowns, factor of {:.0f} MB", model().input().mesh.triangle_count(),
                     model().size(), system_.factor_megabytes())});
}

Eigen::VectorXd Newton::carried_over(const LayoutShape& start) {
    Eigen::VectorXd x = transfer(start, model(), retraction_);
    // At corners of strips a small element may still come out crushed or folded over, and fabric everywhere
    // is only nearly as it would hang between the strips.
    relax_while(x, 1e-4);
    try {
        FabricRelaxation(model(), held_, vertex_order_)(model(), x, sums_);
    } catch (const std::bad_alloc&) {
        // It is not needed, and `run` says so when there is not enough memory for what is.
    }
    return x;
}

/// Nonlinear elimination at `x` as long as a sweep lowers the energy by a share `worth` of it.
void Newton::relax_while(Eigen::VectorXd& x, double worth) {
    constexpr int most_sweeps = 10;
    double energy = evaluate(x, Order::gradient, trial_).total();
    for (int sweep = 0; sweep < most_sweeps && std::isfinite(energy); ++sweep) {
        // Forces all over the sheet are the work of Newton's method, which is cheaper there.
        const bool last = !elimination_.is_concentrated(trial_.gradient);
        const double fell = elimination_(model(), x, trial_.gradient, 1);
        energy -= fell;
        if (last || fell < worth * energy) break;
    }
}

Equilibrium Newton::run(const Eigen::VectorXd& start) {
    x_ = retraction_.meet_supports(start);
    rotation_ = infinity;
    Equilibrium result;
    result.residual = infinity;
    result.message = system_.missing_memory(model(), options_.memory_limit_mb);
    try {
        if (result.message.empty()) {
            iterate(result);
        } else {
            terms_ = model().energy_terms(x_);
        }
    } catch (const std::bad_alloc&) {
        result.message = fmt::format("out of memory after {} iterations", iterations_);
    }
    result.x = x_;
    result.energy = terms_;
    result.typical_force = model().typical_force(x_);
    result.iterations = iterations_;
    result.factorizations = system_.factorizations();
    result.residuals = residuals_;
    result.health = model().health(x_);
    result.health.tangled = !tangle(result.health).empty();
    result.log_extension = model().input().options.log_extension;
    return result;
}

/// Whether something else than a minimum ends the run: enough for a start, limits, a stop.
bool Newton::must_stop(Equilibrium& result, int first_iteration) const {
    if (rotation_ < options_.enough_rotation) {
        result.message = "close enough for a start";
    } else if (iterations_ - first_iteration >= options_.max_iterations) {
        result.message = fmt::format("not converged after {} iterations", options_.max_iterations);
    } else if (control_.timed_out()) {
        result.message = fmt::format("the time limit was reached after {} iterations", iterations_);
    } else if (control_.stopped()) {
        result.status = SolveStatus::interrupted;
        result.message = "interrupted";
    } else {
        return false;
    }
    return true;
}

/// One step: solve, line search. False when no step lowers energy or residual.
bool Newton::step(bool exact) {
    const bool solved = exact ? system_.exact_step(here(), rotation_, options_.residual_tolerance_n, step_)
                              : system_.gauss_newton_step(here(), step_);
    if (!solved) return false;
    const std::vector<Vec3> spins = retraction_.spins(x_, step_);
    rotation_ = retraction_.rms_rotation(spins);
    places_.clear();
    if (settles_places_) places_ = bending_places(model(), held_, spins);
    // The next Hessian comes along for less, unless places move before it is wanted or its form is not known.
    const bool last_steps = exact && rotation_ < NewtonSystem::nearly_at_rest && places_.empty() &&
                            system_.wanted(rotation_) == Order::hessian;
    const bool moved = line_search(last_steps ? Order::hessian : Order::gradient);
    if (exact) system_.adapt(halved_);
    return moved;
}

void Newton::iterate(Equilibrium& result) {
    const int first_iteration = iterations_;
    const double tolerance = options_.residual_tolerance_n;
    int escapes = 0;
    bool stalled = false;
    cover_contacts(x_);
    const bool impossible = contact_ && passes_through_itself(model(), x_);
    for (;;) {
        const bool exact = loaded_ || rotation_ <= turning;
        const Order order = exact ? system_.wanted(rotation_) : Order::gauss_newton;
        constexpr double settled = 0.02;  // rad: what leans on the extension now will do so in the end
        if (rotation_ < settled) narrow_extension();
        model().unwind(x_);
        evaluate(order);
        if (residual() <= tolerance && narrow_extension()) evaluate(order);
        report();
        // As dear as an energy, and the last steps hardly change the shape.
        if (rotation_ > NewtonSystem::nearly_at_rest && is_good(x_)) last_good_ = x_;
        result.residual = residual();
        residuals_.push_back(result.residual);
        if (!std::isfinite(terms_.total()) || !std::isfinite(result.residual)) {
            result.message = "the start is not a possible shape: its energy is not finite";
            return;
        }
        if (impossible) {
            result.message = "the start passes through itself: contact cannot undo that";
            return;
        }
        const bool at_rest = result.residual <= tolerance;
        const bool rounded = !at_rest && exact && at_rest_or_rounded(here(), tolerance);
        if (at_rest || rounded || stalled) {
            if (order_ != Order::hessian) evaluate(Order::hessian);
            result.stable = system_.certify(here());
            if (result.stable || escapes == 5) {
                result.status = at_rest || rounded ? SolveStatus::converged : SolveStatus::not_converged;
                result.message = result.stable ? "strict local minimum" : "stationary, but not a minimum";
                if (rounded) result.message += ", to the last digits of the positions";
                if (stalled && !at_rest && !rounded)
                    result.message = "no step lowers energy or residual any further";
                return;
            }
            ++escapes;
            stalled = false;
            if (!leave_saddle()) {
                result.message = "a saddle that could not be left";
                return;
            }
            rotation_ = turning;
            continue;
        }
        if (must_stop(result, first_iteration)) return;
        ++iterations_;
        stalled = !step(exact);
        if (stalled && !exact) {
            // Try the exact Hessian before giving up.
            rotation_ = turning;
            evaluate(Order::hessian);
            stalled = !step(true);
        }
        if (!stalled) {
            relax_spots();
            settle_places(x_);
            if (!exact && rotation_ <= turning) smooth();
        }
    }
}

}  // namespace ruche
