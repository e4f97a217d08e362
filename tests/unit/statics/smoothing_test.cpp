#include "ruche/statics/smoothing.hpp"

#include <doctest/doctest.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <limits>
#include <vector>

#include "energy/samples.hpp"
#include "ruche/statics/equilibrium.hpp"
#include "ruche/statics/starts.hpp"

using namespace ruche;
using namespace ruche::test;

namespace {

/// Two strips at rest with every unknown a little out of place; three vertices are held.
struct Rough {
    Model model;
    Eigen::VectorXd rest;
    Eigen::VectorXd x;
    std::vector<char> held;
    AssembledSums sums;  // at x, the Gauss-Newton form; values that are floats, as the sweeps take them

    Rough() : model(two_strips()), rest(solve(model).x), x(rest), held(model.size(), 0) {
        for (Eigen::Index i = 0; i < x.size(); ++i) x[i] += 1e-3 * noise(7, static_cast<int>(i));
        for (const int vertex : {0, 5, model.vertex_count() - 1}) {
            held[3 * vertex + 1] = 1;
            x.segment<3>(3 * vertex) = rest.segment<3>(3 * vertex);
        }
        model.evaluate(x, Order::gauss_newton, sums);
        for (double& value : sums.hessian) value = static_cast<float>(value);
    }
    Eigen::VectorXd step(int sweeps) const {
        return smoothing_step(model.pattern(), held, sums.hessian, sums.gradient, sweeps);
    }
};

/// Blocks of the nodes that may move, all else 0 but 1 on the diagonal.
Eigen::MatrixXd matrix_of_moving(const Rough& sheet) {
    const NodePattern& pattern = sheet.model.pattern();
    Eigen::MatrixXd matrix = pattern.full_matrix(sheet.sums.hessian);
    for (int node = 0; node < pattern.node_count(); ++node) {
        const int first = pattern.first_unknown(node);
        bool stays = false;
        for (int c = 0; c < pattern.node_size(node); ++c) stays |= sheet.held[first + c] != 0;
        for (int c = 0; c < pattern.node_size(node) && stays; ++c) {
            matrix.row(first + c).setZero();
            matrix.col(first + c).setZero();
            matrix(first + c, first + c) = 1.0;
        }
    }
    return matrix;
}

}  // namespace

TEST_CASE("smoothing: each sweep is one of conjugate gradients with symmetric Gauss-Seidel by node") {
    const Rough sheet;
    const NodePattern& pattern = sheet.model.pattern();
    const Eigen::MatrixXd matrix = matrix_of_moving(sheet);
    Eigen::MatrixXd lower = Eigen::MatrixXd::Zero(matrix.rows(), matrix.cols());
    Eigen::MatrixXd diagonal = lower;
    Eigen::VectorXd rest = -sheet.sums.gradient;
    for (int column = 0; column < pattern.node_count(); ++column) {
        const int first = pattern.first_unknown(column);
        const int size = pattern.node_size(column);
        diagonal.block(first, first, size, size) = matrix.block(first, first, size, size);
        const Eigen::Index below = matrix.rows() - first;
        lower.block(first, first, below, size) = matrix.block(first, first, below, size);
        for (int c = 0; c < size; ++c) {
            if (sheet.held[first + c] != 0) rest.segment(first, size).setZero();
        }
    }
    // With edge unknowns after the vertices, nodes are in the order of their unknowns.
    const auto precondition = [&](const Eigen::VectorXd& r) -> Eigen::VectorXd {
        return lower.transpose().partialPivLu().solve(diagonal * lower.partialPivLu().solve(r));
    };
    Eigen::VectorXd expected = Eigen::VectorXd::Zero(rest.size());
    Eigen::VectorXd direction = precondition(rest);
    double product = rest.dot(direction);
    for (int sweep = 1; sweep <= 4; ++sweep) {
        const Eigen::VectorXd pull = matrix * direction;
        const double length = product / direction.dot(pull);
        expected += length * direction;
        rest -= length * pull;
        const Eigen::VectorXd next = precondition(rest);
        direction = next + (rest.dot(next) / product) * direction;
        product = rest.dot(next);
        CAPTURE(sweep);
        CHECK((sheet.step(sweep) - expected).norm() < 1e-9 * expected.norm());
    }
}

TEST_CASE("smoothing: many sweeps solve the system, what is held stays") {
    const Rough sheet;
    const Eigen::VectorXd step = sheet.step(3000);
    const Eigen::MatrixXd matrix = matrix_of_moving(sheet);
    Eigen::VectorXd rest = -sheet.sums.gradient - matrix * step;
    for (int v = 0; v < sheet.model.vertex_count(); ++v) {
        if (sheet.held[3 * v + 1] == 0) continue;
        CHECK(step.segment<3>(3 * v) == Vec3::Zero());
        rest.segment<3>(3 * v).setZero();
    }
    CHECK(rest.norm() < 1e-6 * sheet.sums.gradient.norm());
}

TEST_CASE("smoothing: a few sweeps take short waves out") {
    const Rough sheet;
    const double end = sheet.model.energy(sheet.rest);
    const double before = sheet.model.energy(sheet.x) - end;
    REQUIRE(before > 0.0);
    double last = before;
    for (const int sweeps : {1, 4, 12}) {
        const double left = sheet.model.energy(sheet.x + sheet.step(sweeps)) - end;
        CHECK(left < last);
        last = left;
    }
    CHECK(last < 0.002 * before);
}

TEST_CASE("smoothing: where the matrix curves down it ends with a descent, or with nothing") {
    Rough sheet;
    const NodePattern& pattern = sheet.model.pattern();
    const auto shift = [&](double by) {
        for (int node = 0; node < pattern.node_count(); ++node) {
            const int block = pattern.block_offset(node, node);
            for (int c = 0; c < pattern.node_size(node); ++c)
                sheet.sums.hessian[block + c * pattern.column_length(node) + c] += by;
        }
    };
    double least = std::numeric_limits<double>::infinity();  // eigenvalue of a diagonal block
    const Eigen::MatrixXd matrix = matrix_of_moving(sheet);
    for (int v = 0; v < sheet.model.vertex_count(); ++v) {
        const Mat3 block = matrix.block<3, 3>(3 * v, 3 * v);
        least = std::min(least, Eigen::SelfAdjointEigenSolver<Mat3>(block).eigenvalues()[0]);
    }
    for (int u = 3 * sheet.model.vertex_count(); u < sheet.model.size(); ++u)
        least = std::min(least, matrix(u, u));
    shift(-0.9 * least);
    REQUIRE(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(matrix_of_moving(sheet)).eigenvalues()[0] < 0.0);
    const Eigen::VectorXd step = sheet.step(100);
    CHECK(step.allFinite());
    CHECK(step.dot(sheet.sums.gradient) < 0.0);
    CHECK(step == sheet.step(1000));
    shift(-0.2 * least);
    CHECK(sheet.step(100) == Eigen::VectorXd::Zero(sheet.model.size()));
}
