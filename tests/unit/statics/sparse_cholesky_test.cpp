#include "ruche/statics/sparse_cholesky.hpp"

#include <doctest/doctest.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "ruche/core/parallel.hpp"
#include "ruche/meshing/structured.hpp"

using namespace ruche;

namespace {

/// A stiffness matrix as shells have them: `side`² vertices on a grid with three unknowns each, random
/// symmetric blocks between neighbours (diagonals too), and on the diagonal `dominance` times the sum of a
/// row, plus one.
Eigen::SparseMatrix<double> grid_matrix(int side, double dominance) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> entry(-1.0, 1.0);
    std::vector<Eigen::Triplet<double>> lower;
    std::vector<double> row_sum(3 * side * side, 0.0);
    const auto add_block = [&](int a, int b) {
        for (int r = 0; r < 3; ++r) {
            for (int c = 0; c < 3; ++c) {
                const double value = entry(random);
                lower.emplace_back(3 * a + r, 3 * b + c, value);
                row_sum[3 * a + r] += std::abs(value);
                row_sum[3 * b + c] += std::abs(value);
            }
        }
    };
    for (int y = 0; y < side; ++y) {
        for (int x = 0; x < side; ++x) {
            const int v = y * side + x;
            if (x > 0) add_block(v, v - 1);
            if (y > 0) add_block(v, v - side);
            if (x > 0 && y > 0) add_block(v, v - side - 1);
        }
    }
    for (int i = 0; i < 3 * side * side; ++i) lower.emplace_back(i, i, 1.0 + dominance * row_sum[i]);
    Eigen::SparseMatrix<double> matrix(3 * side * side, 3 * side * side);
    matrix.setFromTriplets(lower.begin(), lower.end());
    return matrix;
}

Eigen::MatrixXd dense(const Eigen::SparseMatrix<double>& lower) {
    const Eigen::SparseMatrix<double> full = lower.selfadjointView<Eigen::Lower>();
    return full;
}

SymmetricPattern pattern_of(const Eigen::SparseMatrix<double>& a) {
    return {static_cast<int>(a.rows()),
            {a.outerIndexPtr(), static_cast<std::size_t>(a.cols()) + 1},
            {a.innerIndexPtr(), static_cast<std::size_t>(a.nonZeros())}};
}

std::span<const double> values_of(const Eigen::SparseMatrix<double>& a) {
    return {a.valuePtr(), static_cast<std::size_t>(a.nonZeros())};
}

/// Nested dissection of the unknowns' own graph.
std::vector<int> order_of(const Eigen::SparseMatrix<double>& a) {
    const Eigen::SparseMatrix<double> full = a.selfadjointView<Eigen::Lower>();
    std::vector<int> start = {0};
    std::vector<int> neighbours;
    for (int column = 0; column < full.cols(); ++column) {
        for (Eigen::SparseMatrix<double>::InnerIterator it(full, column); it; ++it) {
            if (it.row() != column) neighbours.push_back(static_cast<int>(it.row()));
        }
        start.push_back(static_cast<int>(neighbours.size()));
    }
    return nested_dissection(start, neighbours);
}

SparseCholesky analysed(const Eigen::SparseMatrix<double>& a) { return {pattern_of(a), order_of(a)}; }

Eigen::MatrixXd right_hand_sides(Eigen::Index rows, Eigen::Index count) {
    Eigen::MatrixXd b(rows, count);
    for (Eigen::Index i = 0; i < b.size(); ++i) b.data()[i] = std::sin(1.0 + 0.37 * static_cast<double>(i));
    return b;
}

}  // namespace

TEST_CASE("sparse Cholesky: solves as a dense factorisation does, for one and for several right-hand sides") {
    for (const int side : {1, 2, 5, 17}) {
        CAPTURE(side);
        const Eigen::SparseMatrix<double> a = grid_matrix(side, 0.6);
        const Eigen::MatrixXd full = dense(a);
        const Eigen::LLT<Eigen::MatrixXd> factor(full);
        REQUIRE(factor.info() == Eigen::Success);
        SparseCholesky sparse = analysed(a);
        REQUIRE(sparse.factorize(values_of(a)));
        for (const int count : {1, 3, 1}) {
            const Eigen::MatrixXd b = right_hand_sides(a.rows(), count);
            const Eigen::MatrixXd expected = factor.solve(b);
            const Eigen::MatrixXd found = sparse.solve(b);
            CHECK((found - expected).norm() < 1e-11 * expected.norm());
        }
    }
}

TEST_CASE("sparse Cholesky: a matrix is accepted exactly when its smallest eigenvalue is positive") {
    const Eigen::SparseMatrix<double> a = grid_matrix(9, 0.3);
    const Eigen::MatrixXd full = dense(a);
    const double lowest = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(full).eigenvalues()[0];
    const double size = full.norm();
    SparseCholesky sparse = analysed(a);
    const auto shifted_by = [&](double shift) {
        Eigen::SparseMatrix<double> shifted = a;
        for (int i = 0; i < a.rows(); ++i) shifted.coeffRef(i, i) += shift;
        return sparse.factorize(values_of(shifted));
    };
    CHECK(shifted_by(-lowest + 1e-10 * size));
    CHECK_FALSE(shifted_by(-lowest - 1e-10 * size));
    CHECK(shifted_by(-lowest + 1.0));
}

TEST_CASE("sparse Cholesky: numbers that are not finite are refused, and do no harm to the next matrix") {
    const Eigen::SparseMatrix<double> a = grid_matrix(8, 0.6);
    SparseCholesky sparse = analysed(a);
    for (const double bad :
         {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        for (const int at : {0, 40, 191}) {
            Eigen::SparseMatrix<double> spoilt = a;
            spoilt.coeffRef(at, at) = bad;
            CHECK_FALSE(sparse.factorize(values_of(spoilt)));
        }
    }
    REQUIRE(sparse.factorize(values_of(a)));
    const Eigen::VectorXd b = right_hand_sides(a.rows(), 1);
    const Eigen::VectorXd x = sparse.solve(b);
    CHECK((a.selfadjointView<Eigen::Lower>() * x - b).norm() < 1e-12 * b.norm());
}

TEST_CASE("sparse Cholesky: same bits at any number of threads, where panels are cut into tiles too") {
    // The widest separator of this grid has some 200 columns, more than a tile.
    const Eigen::SparseMatrix<double> a = grid_matrix(64, 0.6);
    const Eigen::MatrixXd b = right_hand_sides(a.rows(), 2);
    const int before = thread_count();
    Eigen::MatrixXd first;
    for (const int threads : {1, 2, 3, 5}) {
        CAPTURE(threads);
        set_thread_count(threads);
        SparseCholesky sparse = analysed(a);
        REQUIRE(sparse.factorize(values_of(a)));
        const Eigen::MatrixXd x = sparse.solve(b);
        if (first.size() == 0) first = x;
        CHECK(std::memcmp(x.data(), first.data(), sizeof(double) * static_cast<std::size_t>(x.size())) == 0);
    }
    set_thread_count(before);
    CHECK((a.selfadjointView<Eigen::Lower>() * first - b).norm() < 1e-12 * b.norm());
}

TEST_CASE("sparse Cholesky: a solve along with the factorisation has the bits of one after it") {
    const Eigen::SparseMatrix<double> a = grid_matrix(64, 0.6);
    const Eigen::VectorXd b = right_hand_sides(a.rows(), 1);
    Eigen::SparseMatrix<double> indefinite = a;
    indefinite.coeffRef(5000, 5000) = -1.0;
    const int before = thread_count();
    SparseCholesky sparse = analysed(a);
    REQUIRE(sparse.factorize(values_of(a)));
    const Eigen::VectorXd after = sparse.solve(b);
    for (const int threads : {1, 3}) {
        CAPTURE(threads);
        set_thread_count(threads);
        Eigen::VectorXd along;
        REQUIRE(sparse.factorize_and_solve(values_of(a), b, along));
        CHECK(along == after);
        CHECK_FALSE(sparse.factorize_and_solve(values_of(indefinite), b, along));
    }
    set_thread_count(before);
}

TEST_CASE(
    "sparse Cholesky: narrowed, the error is that of single precision times the root of the condition") {
    const double single = std::numeric_limits<float>::epsilon();
    for (const double softest : {1e-2, 1e-6, 1e-10}) {
        CAPTURE(softest);
        Eigen::SparseMatrix<double> a = grid_matrix(17, 0.3);
        const Eigen::VectorXd eigenvalues =
            Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(dense(a)).eigenvalues();
        const double highest = eigenvalues[a.rows() - 1] - eigenvalues[0];
        for (int i = 0; i < a.rows(); ++i) a.coeffRef(i, i) += softest * highest - eigenvalues[0];
        const double root_of_condition = 1.0 / std::sqrt(softest);
        const Eigen::MatrixXd full = dense(a);
        const Eigen::VectorXd b = right_hand_sides(a.rows(), 1);
        const auto norm = [&](const Eigen::VectorXd& x) { return std::sqrt(x.dot(full * x)); };
        SparseCholesky sparse = analysed(a);
        REQUIRE(sparse.factorize(values_of(a)));
        const Eigen::VectorXd exact = sparse.solve(b);
        sparse.narrow();
        sparse.narrow();  // once is enough
        const Eigen::VectorXd rough = sparse.solve(b);
        const double error = norm(rough - exact) / norm(exact);
        CHECK(error > 0.01 * single);  // it is in single precision
        CHECK(error < single * root_of_condition);
        REQUIRE(sparse.factorize(values_of(a)));
        CHECK(Eigen::VectorXd(sparse.solve(b)) == exact);
    }
}

TEST_CASE("sparse Cholesky: a model's nodes of one and of three unknowns are expanded in their places") {
    ModelInput input;
    input.mesh = rectangle_mesh(MeshKind::alternating, {.length = 6.0, .width = 3.0, .across = 4});
    input.print.resize(input.mesh.triangles.size());
    for (std::size_t t = 0; t < input.print.size() / 2; ++t) input.print[t].front = 0.5;
    const Model model(std::move(input));
    REQUIRE(model.size() > 3 * model.vertex_count());  // it has edge unknowns
    AssembledSums sums;
    model.evaluate(model.initial(), Order::gauss_newton, sums);
    const auto& start = model.pattern().column_start();
    Eigen::MatrixXd full = model.pattern().full_matrix(sums.hessian).toDense();
    const double shift = 1e-3 * full.diagonal().mean();
    for (int u = 0; u < model.size(); ++u) {
        const auto* row = model.pattern().row_index().data();
        const auto at = std::lower_bound(row + start[u], row + start[u + 1], u) - row;
        sums.hessian[static_cast<std::size_t>(at)] += shift;
    }
    full.diagonal().array() += shift;
    SparseCholesky sparse(model, vertex_elimination_order(model.pattern()));
    REQUIRE(sparse.factorize(sums.hessian));
    const Eigen::MatrixXd b = right_hand_sides(model.size(), 2);
    const Eigen::MatrixXd expected = full.llt().solve(b);
    CHECK((sparse.solve(b) - expected).norm() < 1e-9 * expected.norm());
}
