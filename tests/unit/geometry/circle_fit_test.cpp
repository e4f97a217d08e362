#include "ruche/geometry/circle_fit.hpp"

#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <vector>

using namespace ruche;

namespace {

/// Points on an arc of the given curvature and length, in an arbitrary plane far from the origin.
std::vector<Vec3> arc(double curvature, double length, int count, const Mat3& frame, const Vec3& shift) {
    std::vector<Vec3> points;
    for (int i = 0; i < count; ++i) {
        const double s = length * (static_cast<double>(i) / (count - 1) - 0.5);
        const double half = 0.5 * curvature * s;  // 1 - cos without cancellation
        const double sagitta = curvature == 0.0 ? 0.0 : 2.0 * std::sin(half) * std::sin(half) / curvature;
        const double along = curvature == 0.0 ? s : std::sin(curvature * s) / curvature;
        points.push_back(shift + frame * Vec3(along, sagitta, 0.0));
    }
    return points;
}

const Mat3 tilted = Eigen::AngleAxisd(1.1, Vec3(1, -2, 0.5).normalized()).toRotationMatrix();
const Vec3 away(7.0, -3.0, 11.0);

}  // namespace

TEST_CASE("circle fit: analytic arcs of any length are met to rounding") {
    for (const double curvature : {0.15, 0.05, 1.0, 1e-3}) {
        for (const double turn : {0.3, 1.0, M_PI, 2 * M_PI, 15.0}) {
            const double length = turn / curvature;
            CAPTURE(curvature);
            CAPTURE(turn);
            const CircleFit fit = fit_circle(arc(curvature, length, 61, tilted, away));
            REQUIRE(fit.valid);
            CHECK(fit.curvature == doctest::Approx(curvature).epsilon(1e-12));
            CHECK(fit.radius() == doctest::Approx(1.0 / curvature).epsilon(1e-12));
            CHECK((fit.centre() - (away + tilted * Vec3(0, 1.0 / curvature, 0))).norm() < 1e-12 / curvature);
            CHECK(std::abs(fit.normal.dot(tilted.col(2))) == doctest::Approx(1.0).epsilon(1e-12));
            CHECK(fit.rms < 1e-13 * length);
        }
    }
}

TEST_CASE("circle fit: a nearly straight arc keeps its curvature and the side it bends to") {
    // Points 30 mm apart are rounded to 4e-15 mm, so the curvature of 8 * sagitta / length^2 is good to
    // 1e-16.
    for (const double curvature : {1e-4, 1e-6, 1e-8}) {
        const CircleFit fit = fit_circle(arc(curvature, 30.0, 31, tilted, Vec3::Zero()));
        REQUIRE(fit.valid);
        CHECK(std::abs(fit.curvature - curvature) < 1e-15);
        CHECK(fit.inward.dot(tilted.col(1)) > 0.999);
    }
}

TEST_CASE("circle fit: points on a line have no curvature") {
    const CircleFit fit = fit_circle(arc(0.0, 30.0, 11, tilted, away));
    REQUIRE(fit.valid);
    CHECK(fit.curvature < 1e-15);
    CHECK(fit.rms < 1e-13);
}

TEST_CASE("circle fit: the order of the points does not matter") {
    std::vector<Vec3> points = arc(0.1, 40.0, 25, tilted, away);
    const CircleFit before = fit_circle(points);
    std::shuffle(points.begin(), points.end(), std::mt19937(3));
    CHECK(fit_circle(points).curvature == doctest::Approx(before.curvature).epsilon(1e-12));
}

TEST_CASE("circle fit: noise moves the curvature by its standard error only, and rms shows it") {
    // Independent errors sigma on n points of an arc of length L: var(kappa) = 720 sigma^2 / (n L^4) for
    // short arcs (least-squares parabola); five standard errors are allowed.
    constexpr double sigma = 1e-3;
    constexpr double length = 20.0;
    constexpr int count = 200;
    std::mt19937 random(11);
    std::normal_distribution<double> error(0.0, sigma);
    std::vector<Vec3> points = arc(0.02, length, count, tilted, away);
    for (Vec3& p : points) p += Vec3(error(random), error(random), error(random));
    const CircleFit fit = fit_circle(points);
    CHECK(std::abs(fit.curvature - 0.02) < 5 * std::sqrt(720.0 / count) * sigma / (length * length));
    // Two of the three components are seen as distance to the circle.
    CHECK(fit.rms == doctest::Approx(std::sqrt(2.0) * sigma).epsilon(0.1));
}

TEST_CASE("circle fit: with noise it is a minimum of the squared distances") {
    std::mt19937 random(5);
    std::normal_distribution<double> error(0.0, 0.05);
    std::vector<Vec3> points = arc(0.2, 25.0, 80, Mat3::Identity(), Vec3::Zero());
    for (Vec3& p : points) p += Vec3(error(random), error(random), 0.0);
    const CircleFit fit = fit_circle(points);
    const auto cost = [&](const Vec3& centre, double radius) {
        double sum = 0.0;
        for (const Vec3& p : points) sum += std::pow((p - centre).norm() - radius, 2);
        return sum;
    };
    const double best = cost(fit.centre(), fit.radius());
    CHECK(fit.rms == doctest::Approx(std::sqrt(best / 80)).epsilon(1e-10));
    for (const double step : {1e-4, -1e-4}) {
        CHECK(cost(fit.centre() + Vec3(step, 0, 0), fit.radius()) > best);
        CHECK(cost(fit.centre() + Vec3(0, step, 0), fit.radius()) > best);
        CHECK(cost(fit.centre(), fit.radius() + step) > best);
    }
}

TEST_CASE("circle fit: too few, equal or non-finite points give no fit") {
    CHECK_FALSE(fit_circle({}).valid);
    CHECK_FALSE(fit_circle(std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}}).valid);
    CHECK_FALSE(fit_circle(std::vector<Vec3>(5, Vec3(1, 2, 3))).valid);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    CHECK_FALSE(fit_circle(std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {2, nan, 0}}).valid);
}

TEST_CASE("circle fit: its rate of change is the derivative for moving points") {
    std::mt19937 random(7);
    std::normal_distribution<double> normal;
    for (const double turn : {0.2, 1.0, 4.0, 15.0}) {
        const double curvature = 0.08;
        std::vector<Vec3> points = arc(curvature, turn / curvature, 25, tilted, away);
        std::vector<Vec3> velocities;
        for (Vec3& p : points) {
            for (int c = 0; c < 3; ++c) p[c] += 1e-3 * normal(random);  // off the circle and its plane
            velocities.emplace_back(normal(random), normal(random), normal(random));
        }
        const auto moved = [&](double t) {
            std::vector<Vec3> at = points;
            for (std::size_t i = 0; i < at.size(); ++i) at[i] += t * velocities[i];
            return fit_circle(at);
        };
        const CircleFit fit = moved(0.0);
        const CircleRate rate = circle_rate(fit, points, velocities);
        // Central differences with Richardson extrapolation; the fit stops at rounding.
        const auto derivative = [&](const std::function<Vec3(const CircleFit&)>& of) -> Vec3 {
            const double h = 1e-4 * turn;
            const Vec3 wide = (of(moved(h)) - of(moved(-h))) / (2.0 * h);
            const Vec3 narrow = (of(moved(0.5 * h)) - of(moved(-0.5 * h))) / h;
            return (4.0 * narrow - wide) / 3.0;
        };
        const auto same_side = [&](const CircleFit& f) -> Vec3 {
            return f.normal.dot(fit.normal) < 0.0 ? Vec3(-f.normal) : f.normal;
        };
        CAPTURE(turn);
        const double curvature_rate =
            derivative([](const CircleFit& f) { return Vec3(f.curvature, 0, 0); }).x();
        CHECK(rate.curvature == doctest::Approx(curvature_rate).epsilon(1e-7));
        const Vec3 centre = derivative([](const CircleFit& f) { return f.centre(); });
        CHECK((rate.centre - centre).norm() < 1e-7 * centre.norm());
        const Vec3 plane = derivative(same_side);
        CHECK((rate.normal - plane).norm() < 1e-7 * plane.norm());
    }
}
