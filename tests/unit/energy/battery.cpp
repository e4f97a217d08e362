#include "energy/battery.hpp"

#include <doctest/doctest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace ruche::test {
namespace {

constexpr int levels = 5;

/// Central differences of a function at steps h, h/2, ..., their Richardson extrapolation, and the exact
/// value they must approach.
void check_convergence(const std::function<Eigen::VectorXd(double)>& difference, const Eigen::VectorXd& exact,
                       double scale, double step) {
    std::vector<Eigen::VectorXd> row;
    std::array<double, levels> errors{};
    for (int k = 0; k < levels; ++k, step *= 0.5) {
        row.push_back(difference(step));
        errors[k] = (row.back() - exact).cwiseAbs().maxCoeff();
    }
    for (int order = 1; order < levels; ++order) {
        const double weight = std::pow(4.0, order);
        for (int k = 0; k + order < levels; ++k) {
            row[k] = Eigen::VectorXd((weight * row[k + 1] - row[k]) / (weight - 1.0));
        }
    }
    CHECK((row[0] - exact).cwiseAbs().maxCoeff() <= 1e-8 * scale);
    // The order of the finest pair of steps whose errors stand above rounding.
    for (int k = levels - 2; k >= 0; --k) {
        if (errors[k + 1] < 1e-8 * scale) continue;
        const double observed = std::log2(errors[k] / errors[k + 1]);
        CHECK(observed == doctest::Approx(2.0).epsilon(0.1));
        break;
    }
}

Eigen::VectorXd random_direction(int size, std::mt19937& random) {
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    Eigen::VectorXd w(size);
    for (double& c : w) c = uniform(random);
    return w;
}

double largest(const Eigen::MatrixXd& m) { return m.size() == 0 ? 0.0 : m.cwiseAbs().maxCoeff(); }

}  // namespace

Energy energy_of(const Model& model) {
    return {model.vertex_count(), model.size(), [&model](const Eigen::VectorXd& x, Order order) -> Sums {
                const int size = model.size();
                AssembledSums sums;
                const double value = model.evaluate(x, order, sums).total();
                const auto zero = [&]() -> Eigen::MatrixXd { return Eigen::MatrixXd::Zero(size, size); };
                return {value, order == Order::value ? Eigen::VectorXd::Zero(size) : sums.gradient,
                        order.wants_hessian() ? model.pattern().full_matrix(sums.hessian).toDense() : zero()};
            }};
}

Eigen::VectorXd Motion::turn(const Energy& energy, const Eigen::VectorXd& gradient) const {
    Eigen::VectorXd moved = gradient;
    for (int v = 0; v < energy.vertex_count; ++v) {
        moved.segment<3>(3 * v) = rotation * gradient.segment<3>(3 * v);
    }
    moved.tail(energy.size - 3 * energy.vertex_count) *= rotation.determinant() > 0.0 ? 1.0 : -1.0;
    return moved;
}

Eigen::VectorXd Motion::operator()(const Energy& energy, const Eigen::VectorXd& x) const {
    Eigen::VectorXd moved = turn(energy, x);
    for (int v = 0; v < energy.vertex_count; ++v) moved.segment<3>(3 * v) += translation;
    return moved;
}

Motion random_motion(std::mt19937& random) {
    std::normal_distribution<double> normal;
    const Eigen::Quaterniond q =
        Eigen::Quaterniond(normal(random), normal(random), normal(random), normal(random)).normalized();
    return {q.toRotationMatrix(), Vec3(normal(random), normal(random), normal(random))};
}

Motion turn_about_z(double angle, const Vec3& translation) {
    return {Eigen::AngleAxisd(angle, Vec3::UnitZ()).toRotationMatrix(), translation};
}

Motion mirror_z() { return {Vec3(1.0, 1.0, -1.0).asDiagonal(), Vec3::Zero()}; }

void check_derivatives(const Energy& energy, const Eigen::VectorXd& x, double step) {
    std::mt19937 random(7);
    const Sums at = energy.evaluate(x, Order::hessian);
    REQUIRE(std::isfinite(at.value));
    for (int repeat = 0; repeat < 3; ++repeat) {
        CAPTURE(repeat);
        const Eigen::VectorXd w = random_direction(energy.size, random);
        const Eigen::VectorXd exact = Eigen::VectorXd::Constant(1, at.gradient.dot(w));
        check_convergence(
            [&](double h) -> Eigen::VectorXd {
                const double slope = (energy.value(x + h * w) - energy.value(x - h * w)) / (2.0 * h);
                return Eigen::VectorXd::Constant(1, slope);
            },
            exact, std::max(at.gradient.cwiseAbs().dot(w.cwiseAbs()), step * largest(at.hessian)), step);
        check_convergence(
            [&](double h) -> Eigen::VectorXd {
                return (energy.gradient(x + h * w) - energy.gradient(x - h * w)) / (2.0 * h);
            },
            at.hessian* w, largest(at.hessian), step);
    }
}

void check_orders(const Energy& energy, const Eigen::VectorXd& x) {
    const Sums value = energy.evaluate(x, Order::value);
    const Sums gradient = energy.evaluate(x, Order::gradient);
    const Sums hessian = energy.evaluate(x, Order::hessian);
    CHECK(value.value == hessian.value);
    CHECK(gradient.value == hessian.value);
    CHECK(gradient.gradient == hessian.gradient);
    CHECK(largest(hessian.hessian - hessian.hessian.transpose()) <= 1e-13 * largest(hessian.hessian));
    const Sums part = energy.evaluate(x, Order::gauss_newton);
    CHECK(part.value == hessian.value);
    CHECK(part.gradient == hessian.gradient);
    CHECK(largest(part.hessian - part.hessian.transpose()) <= 1e-13 * largest(part.hessian));
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(part.hessian, Eigen::EigenvaluesOnly);
    // Rounding of an eigenvalue: a few units in the last place of the largest one.
    CHECK(eigen.eigenvalues().minCoeff() >= -1e-13 * eigen.eigenvalues().cwiseAbs().maxCoeff());
    for (const double share : {0.0, 0.3, 1.0}) {
        const Sums mean = energy.evaluate(x, Order::mean(share));
        CHECK(mean.value == hessian.value);
        CHECK(mean.gradient == hessian.gradient);
        CHECK(largest(mean.hessian - (1.0 - share) * hessian.hessian - share * part.hessian) <=
              1e-13 * (largest(hessian.hessian) + largest(part.hessian)));
    }
}

void check_same(const Sums& a, const Sums& b, double tolerance) {
    // Positions of about 1 mm are rounded by less than 1e-14 mm: near a state of rest that is what counts.
    constexpr double rounding = 1e-14;
    const double gradient = largest(b.gradient);
    const double hessian = largest(b.hessian);
    CHECK(std::abs(a.value - b.value) <=
          tolerance * std::abs(b.value) + rounding * gradient + rounding * rounding * hessian);
    CHECK(largest(a.gradient - b.gradient) <= tolerance * gradient + rounding * hessian);
    CHECK(largest(a.hessian - b.hessian) <= tolerance * hessian);
}

void check_invariance(const Energy& energy, const Energy& moved, const Motion& motion,
                      const Eigen::VectorXd& x) {
    const Sums here = energy.evaluate(x, Order::hessian);
    const Sums there = moved.evaluate(motion(energy, x), Order::hessian);
    Sums expected{here.value, motion.turn(energy, here.gradient), here.hessian};
    for (int c = 0; c < energy.size; ++c) {
        expected.hessian.col(c) = motion.turn(energy, expected.hessian.col(c));
    }
    for (int r = 0; r < energy.size; ++r) {
        expected.hessian.row(r) = motion.turn(energy, expected.hessian.row(r).transpose()).transpose();
    }
    check_same(there, expected, 1e-11);
}

void check_battery(const Energy& energy, const Eigen::VectorXd& x, double step) {
    check_derivatives(energy, x, step);
    check_orders(energy, x);
    std::mt19937 random(11);
    check_invariance(energy, energy, random_motion(random), x);
}

void check_thread_independent(const std::function<Sums()>& run) {
    const int before = thread_count();
    set_thread_count(1);
    const Sums serial = run();
    for (const int threads : {2, 5}) {
        CAPTURE(threads);
        set_thread_count(threads);
        const Sums parallel = run();
        CHECK(parallel.value == serial.value);
        CHECK(parallel.gradient == serial.gradient);
        CHECK(parallel.hessian == serial.hessian);
    }
    set_thread_count(before);
}

}  // namespace ruche::test
