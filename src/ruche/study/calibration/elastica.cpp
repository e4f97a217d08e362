#include "ruche/study/calibration/elastica.hpp"

#include <array>
#include <boost/math/tools/toms748_solve.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_fehlberg78.hpp>
#include <cmath>
#include <numbers>

namespace ruche {
namespace {

namespace odeint = boost::numeric::odeint;

/// An angle, its derivative, and the integrals of the sines of it and of its complement. The angle is theta
/// for strips that hang little and pi/2 - theta for those that hang steeply, so that no digits cancel.
using State = std::array<double, 4>;
using Stepper = odeint::runge_kutta_fehlberg78<State>;
constexpr double half_turn = 0.5 * std::numbers::pi;

/// A member of the family by q in (0, inf): the tip's angle is the Gudermannian of q, its complement 2
/// atan(exp(-q)).
Cantilever member(double q) {
    const double tip = 2.0 * std::atan(std::tanh(0.5 * q));
    const double complement = 2.0 * std::atan(std::exp(-q));
    const bool steep = complement < 0.5;
    const auto derivative = [steep](const State& s, State& d, double u) {
        d[0] = s[1];
        d[1] = steep ? u * std::sin(s[0]) : -u * std::cos(s[0]);
        d[2] = std::sin(s[0]);
        d[3] = std::cos(s[0]);
    };
    const auto horizontal = [steep](const State& s) { return steep ? half_turn - s[0] : s[0]; };
    const double start = steep ? complement : tip;
    // The angle changes over lengths of 1 and, where it grows like Airy's function, of u^(-1/2) > 0.2: with
    // this step the error of order h^8 is rounding.
    constexpr double step = 0.02;
    Stepper stepper;
    State state{start, 0.0, 0.0, 0.0};
    State before = state;
    double u = 0.0;
    for (double at = 0.0; horizontal(state) > 0.0; at += step) {
        before = state;
        u = at;
        stepper.do_step(derivative, state, at, step);
    }
    // The last step went too far: the one that ends where the strip is horizontal, by Newton's method.
    double length = step;
    for (int i = 0; i < 20; ++i) {
        State there = before;
        stepper.do_step(derivative, there, u, length);
        const double change = (steep ? there[0] - half_turn : there[0]) / there[1];
        length -= change;
        state = there;
        if (std::abs(change) < 1e-14 * (u + length)) break;
    }
    const double end = u + length;
    const double sine = state[2] / end;
    const double cosine = state[3] / end;
    return {end * end * end, steep ? sine : cosine, steep ? cosine : sine, tip};
}

/// The member for which a function that grows with q is zero.
template <class Function>
Cantilever where(const Function& function, double low, double high) {
    std::uintmax_t iterations = 200;
    const boost::math::tools::eps_tolerance<double> tolerance(50);
    const auto [a, b] =
        boost::math::tools::toms748_solve([&](double log_q) { return function(member(std::exp(log_q))); },
                                          std::log(low), std::log(high), tolerance, iterations);
    return member(std::exp(0.5 * (a + b)));
}

constexpr double least_q = 1e-8;
constexpr double most_q = 80.0;

}  // namespace

Cantilever cantilever(double load) {
    if (load <= 0.0) return {};
    return where([&](const Cantilever& c) { return std::log(c.load / load); }, least_q, most_q);
}

Cantilever cantilever_of_chord(double angle) {
    return where([&](const Cantilever& c) { return std::atan2(c.drop, c.reach) - angle; }, least_q, most_q);
}

}  // namespace ruche
