#include "ruche/statics/starts.hpp"

#include <doctest/doctest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>
#include <numbers>

#include "ruche/meshing/structured.hpp"

using namespace ruche;

namespace {

constexpr double pi = std::numbers::pi;

Model sheet() {
    ModelInput input;
    input.mesh = rectangle_mesh(MeshKind::jittered, {.length = 40, .width = 10, .across = 20});
    return Model(std::move(input));
}

/// Smallest and largest principal stretch over all triangles.
std::pair<double, double> stretches(const Model& model, const Eigen::VectorXd& x) {
    std::pair<double, double> range = {infinity, 0.0};
    const TriangleMesh& mesh = model.input().mesh;
    for (const Triangle& v : mesh.triangles) {
        Mat2 flat;
        flat << mesh.vertices[v[1]] - mesh.vertices[v[0]], mesh.vertices[v[2]] - mesh.vertices[v[0]];
        Eigen::Matrix<double, 3, 2> now;
        now << x.segment<3>(3 * v[1]) - x.segment<3>(3 * v[0]),
            x.segment<3>(3 * v[2]) - x.segment<3>(3 * v[0]);
        const Eigen::Matrix<double, 3, 2> f = now * flat.inverse();
        const Vec2 squares = Eigen::SelfAdjointEigenSolver<Mat2>(f.transpose() * f).eigenvalues();
        range = {std::min(range.first, std::sqrt(squares[0])), std::max(range.second, std::sqrt(squares[1]))};
    }
    return range;
}

/// Smallest and largest ratio of an edge's length to that in the layout.
std::pair<double, double> edge_stretches(const Model& model, const Eigen::VectorXd& x) {
    std::pair<double, double> range = {infinity, 0.0};
    const TriangleMesh& mesh = model.input().mesh;
    for (const Edge& edge : find_edges(mesh).edges) {
        const auto [a, b] = edge.vertex;
        const double ratio =
            (x.segment<3>(3 * b) - x.segment<3>(3 * a)).norm() / (mesh.vertices[b] - mesh.vertices[a]).norm();
        range = {std::min(range.first, ratio), std::max(range.second, ratio)};
    }
    return range;
}

}  // namespace

TEST_CASE("starts: noise has the size that was asked for, its mean vanishes, and seeds differ") {
    const Model model = sheet();
    const Eigen::VectorXd moved = noisy_start(model, 3, 1e-3) - model.initial();
    CHECK(moved.cwiseAbs().maxCoeff() <= 1e-3);
    CHECK(moved.cwiseAbs().maxCoeff() > 0.99e-3);
    // Uniform in [-1, 1]: standard deviation of the mean 1 / sqrt(3 n), five of them.
    CHECK(std::abs(moved.mean()) < 5e-3 / std::sqrt(3.0 * static_cast<double>(moved.size())));
    CHECK((noisy_start(model, 4, 1e-3) - model.initial() - moved).norm() > 1e-3);
    CHECK(noisy_start(model, 3, 1e-3) == noisy_start(model, 3, 1e-3));
    // Elements of 0.5 mm, vertices moved by up to 0.3 of it: no edge is longer than 1 mm.
    CHECK((noisy_start(model, 3, 10.0) - model.initial()).cwiseAbs().maxCoeff() < 0.01);
}

TEST_CASE("starts: a roll is as long as the sheet, turns as far as was asked for, and stretches nothing") {
    const Model model = sheet();
    for (const double direction : {0.0, 0.5 * pi, 0.3}) {
        CAPTURE(direction);
        const double turn = 1.2 * pi;
        const Eigen::VectorXd x = rolled_start(model, {.direction = direction, .turn = turn});
        // An edge is the chord of an arc of at most 1 mm at a radius of at least 10 mm / turn.
        const auto [least, most] = edge_stretches(model, x);
        CHECK(most < 1.0 + 1e-12);
        CHECK(least > 1.0 - std::pow(1.0 * turn / 10.0, 2) / 24.0);
    }
    // Half a turn along x: the ends are a diameter apart and point down; the front is outside, the middle on
    // top.
    const Eigen::VectorXd x = rolled_start(model, {.direction = 0.0, .turn = pi});
    double lowest = 0.0, left = 0.0, right = 0.0;
    for (int v = 0; v < model.vertex_count(); ++v) {
        left = std::min(left, x[3 * v]);
        right = std::max(right, x[3 * v]);
        lowest = std::min(lowest, x[3 * v + 2]);
    }
    CHECK(right - left == doctest::Approx(2.0 * 40.0 / pi).epsilon(1e-12));
    CHECK(lowest == doctest::Approx(-40.0 / pi).epsilon(1e-12));
    CHECK(rolled_start(model, {.direction = 1.0, .turn = 0.0}) == model.initial());
}

TEST_CASE("starts: hills and valleys are steep but stretch nothing, and seeds differ") {
    const Model model = sheet();
    for (int seed = 1; seed <= 5; ++seed) {
        CAPTURE(seed);
        const Eigen::VectorXd x = wavy_start(model, seed);
        const auto [least, most] = stretches(model, x);
        CHECK(least > 0.8 - 1e-9);  // sqrt(1 - 0.6^2) where it is level
        CHECK(most < 1.0 + 1e-3);   // the slope is taken at vertices, a little more may lie between them
        CHECK(most > 0.95);
        CHECK((wavy_start(model, seed + 1) - x).norm() > 1.0);
    }
}
