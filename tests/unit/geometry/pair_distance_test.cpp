#include "ruche/geometry/pair_distance.hpp"

#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <random>

#include "energy/battery.hpp"

using namespace ruche;
using namespace ruche::test;

namespace {

constexpr PairKind kinds[] = {PairKind::vertex_triangle, PairKind::vertex_edge, PairKind::vertex_vertex,
                              PairKind::edge_edge};

PairCorners random_corners(std::mt19937& random) {
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    PairCorners x;
    for (Vec3& p : x) p = Vec3(uniform(random), uniform(random), uniform(random));
    return x;
}

/// A random point of each part, as coefficients of the vector between them.
Eigen::Vector4d random_coefficients(PairKind kind, std::mt19937& random) {
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    const double s = uniform(random);
    const double t = uniform(random);
    switch (kind) {
        case PairKind::vertex_triangle:
            return s + t < 1.0 ? Eigen::Vector4d(1.0, s + t - 1.0, -s, -t)
                               : Eigen::Vector4d(1.0, 1.0 - s - t, s - 1.0, t - 1.0);
        case PairKind::vertex_edge:
            return {1.0, s - 1.0, -s, 0.0};
        case PairKind::vertex_vertex:
            return {1.0, -1.0, 0.0, 0.0};
        case PairKind::edge_edge:
            return {1.0 - s, s, t - 1.0, -t};
    }
    return {};
}

/// s as the battery sees it: four vertices.
Energy squared_distance(PairKind kind) {
    return {4, 12, [kind](const Eigen::VectorXd& x, Order order) {
                PairCorners at;
                for (int i = 0; i < 4; ++i) at[i] = x.segment<3>(3 * i);
                const ClosestPoints closest = closest_points(kind, at);
                const Vec3 r = shortest_vector(closest, at);
                Sums sums{r.squaredNorm(), Eigen::VectorXd::Zero(12), Eigen::MatrixXd::Zero(12, 12)};
                if (order != Order::value) sums.gradient = squared_distance_gradient(closest, r);
                if (order.wants_hessian()) sums.hessian = squared_distance_hessian(closest, r, at);
                return sums;
            }};
}

Eigen::VectorXd state(const PairCorners& x) {
    Eigen::VectorXd all(12);
    for (int i = 0; i < 4; ++i) all.segment<3>(3 * i) = x[i];
    return all;
}

const Vec3 a(0, 0, 0), b(2, 0, 0), c(0, 2, 0);

}  // namespace

TEST_CASE("pair distance: a vertex over the inside, an edge and a corner of a triangle") {
    CHECK(distance(PairKind::vertex_triangle, {Vec3(0.5, 0.5, 0.3), a, b, c}) == doctest::Approx(0.3));
    CHECK(distance(PairKind::vertex_triangle, {Vec3(1.0, -0.4, 0.3), a, b, c}) == doctest::Approx(0.5));
    CHECK(distance(PairKind::vertex_triangle, {Vec3(3.0, -2.0, 2.0), a, b, c}) == doctest::Approx(3.0));
    CHECK(distance(PairKind::vertex_edge, {Vec3(1.0, 3.0, 4.0), a, b, c}) == doctest::Approx(5.0));
    CHECK(distance(PairKind::vertex_vertex, {Vec3(2.0, 3.0, 6.0), a, b, c}) == doctest::Approx(7.0));
}

TEST_CASE("pair distance: two edges that cross, that miss each other, and parallel ones") {
    CHECK(distance(PairKind::edge_edge, {a, b, Vec3(1, -1, 0.3), Vec3(1, 1, 0.3)}) == doctest::Approx(0.3));
    CHECK(distance(PairKind::edge_edge, {a, b, Vec3(5, -4, 0), Vec3(5, 9, 0)}) == doctest::Approx(3.0));
    CHECK(distance(PairKind::edge_edge, {a, b, Vec3(1, 0.5, 0), Vec3(7, 0.5, 0)}) == doctest::Approx(0.5));
}

TEST_CASE("pair distance: no two points of the parts are closer, and the closest ones belong to them") {
    std::mt19937 random(3);
    for (const PairKind kind : kinds) {
        CAPTURE(static_cast<int>(kind));
        for (int repeat = 0; repeat < 200; ++repeat) {
            const PairCorners x = random_corners(random);
            const ClosestPoints closest = closest_points(kind, x);
            const Vec3 r = shortest_vector(closest, x);
            const int first = kind == PairKind::edge_edge ? 2 : 1;
            CHECK(closest.coefficients.head(first).sum() == doctest::Approx(1.0).epsilon(1e-12));
            CHECK(closest.coefficients.sum() == doctest::Approx(0.0));
            CHECK(closest.coefficients.head(first).minCoeff() >= 0.0);
            CHECK(closest.coefficients.tail(4 - first).maxCoeff() <= 0.0);
            for (int sample = 0; sample < 50; ++sample) {
                const Eigen::Vector4d other = random_coefficients(kind, random);
                Vec3 between = Vec3::Zero();
                for (int i = 0; i < 4; ++i) between += other[i] * x[i];
                CHECK(between.norm() >= r.norm() * (1.0 - 1e-12));
            }
        }
    }
}

TEST_CASE("pair distance: derivatives of its square agree with finite differences in every region") {
    std::mt19937 random(4);
    int inside[3] = {0, 0, 0};
    for (const PairKind kind : kinds) {
        CAPTURE(static_cast<int>(kind));
        for (int repeat = 0; repeat < 20; ++repeat) {
            PairCorners x = random_corners(random);
            // Every other vertex just above the middle of the triangle, so that all regions occur.
            if (kind == PairKind::vertex_triangle && repeat % 2 == 0) x[0] = (x[1] + x[2] + x[3]) / 3.0;
            if (kind == PairKind::vertex_triangle && repeat % 2 == 0) x[0].z() += 0.3;
            ++inside[closest_points(kind, x).freedom];
            check_derivatives(squared_distance(kind), state(x), 1e-5);
        }
    }
    for (const int count : inside) CHECK(count >= 10);
}

TEST_CASE("pair distance: far from the origin it loses no more than the positions do") {
    const Vec3 far(1e4, -2e4, 3e4);
    PairCorners x = {Vec3(0.5, 0.5, 1e-3), a, b, c};
    for (Vec3& p : x) p += far;
    CHECK(distance(PairKind::vertex_triangle, x) == doctest::Approx(1e-3).epsilon(1e-7));
}

TEST_CASE("clear fraction: a fast vertex does not tunnel through a triangle") {
    const PairCorners x = {Vec3(0.5, 0.5, 1.0), a, b, c};
    PairCorners y = x;
    y[0].z() = -1e6;
    // It must stop between 1 and 1.25 times the gap above the plane.
    const double t = clear_fraction(PairKind::vertex_triangle, x, y, 0.1);
    const double height = 1.0 - t * (1.0 + 1e6);
    CHECK(height > 0.1);
    CHECK(height <= 0.125 + 1e-9);
    y[0].z() = 0.2;
    CHECK(clear_fraction(PairKind::vertex_triangle, x, y, 0.1) == 1.0);
}

TEST_CASE("clear fraction: what moves together is free to, however far") {
    std::mt19937 random(5);
    PairCorners x = {Vec3(0.5, 0.5, 1e-3), a, b, c};
    PairCorners y = x;
    for (Vec3& p : y) p += Vec3(1e3, 2e3, -1e3);
    CHECK(clear_fraction(PairKind::vertex_triangle, x, y, 2e-4) == 1.0);
}

TEST_CASE("clear fraction: on the clear part of a random way the distance stays above the gap") {
    std::mt19937 random(6);
    int stopped = 0;
    for (const PairKind kind : kinds) {
        for (int repeat = 0; repeat < 300; ++repeat) {
            const PairCorners x = random_corners(random);
            const PairCorners y = random_corners(random);
            const double gap = 0.2 * distance(kind, x);
            const double t = clear_fraction(kind, x, y, gap);
            stopped += t < 1.0 ? 1 : 0;
            for (int sample = 0; sample <= 50; ++sample) {
                PairCorners at;
                for (int i = 0; i < 4; ++i) at[i] = x[i] + (t * sample / 50.0) * (y[i] - x[i]);
                CHECK(distance(kind, at) > gap);
            }
        }
    }
    CHECK(stopped > 50);
}
