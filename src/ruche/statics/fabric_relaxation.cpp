#include "ruche/statics/fabric_relaxation.hpp"

#include <cmath>

namespace ruche {
namespace {

/// Vertices that only bare triangles have and nothing holds.
std::vector<char> bare_vertices(const Model& model, std::span<const char> held) {
    const ModelInput& input = model.input();
    std::vector<char> bare(model.vertex_count(), 0);
    for (const bool printed : {false, true}) {
        for (int t = 0; t < input.mesh.triangle_count(); ++t) {
            if (input.print[t].bare() == printed) continue;
            for (const int v : input.mesh.triangles[t]) bare[v] = printed ? 0 : 1;
        }
    }
    for (const Rod& rod : input.rods) {
        for (const int v : rod.vertices) bare[v] = 0;
    }
    for (int v = 0; v < model.vertex_count(); ++v) {
        for (int c = 0; c < 3; ++c) bare[v] = bare[v] != 0 && held[3 * v + c] == 0 ? 1 : 0;
    }
    return bare;
}

}  // namespace

FabricRelaxation::FabricRelaxation(const Model& model, std::span<const char> held,
                                   std::span<const int> vertex_order) {
    const NodePattern& pattern = model.pattern();
    const std::vector<char> bare = bare_vertices(model, held);
    std::vector<int> place(pattern.node_count(), -1);
    int count = 0;
    for (int v = 0; v < model.vertex_count(); ++v) {
        if (bare[v] == 0) continue;
        place[v] = count++;
        for (int c = 0; c < 3; ++c) unknowns_.push_back(3 * v + c);
    }
    if (count == 0 || count == model.vertex_count()) return;
    std::vector<int> node_start = {0};
    std::vector<int> node_rows;
    std::vector<int> column_start = {0};
    std::vector<int> row_index;
    for (int v = 0; v < model.vertex_count(); ++v) {
        if (place[v] < 0) continue;
        for (const int row : pattern.rows_of(v)) {
            if (place[row] >= 0) node_rows.push_back(place[row]);
        }
        node_start.push_back(static_cast<int>(node_rows.size()));
        for (int c = 0; c < 3; ++c) {
            for (const int row : pattern.rows_of(v)) {
                if (place[row] < 0) continue;
                const int block = pattern.block_offset(row, v) + c * pattern.column_length(v);
                for (int r = 0; r < 3; ++r) {
                    row_index.push_back(3 * place[row] + r);
                    value_.push_back(block + r);
                }
            }
            column_start.push_back(static_cast<int>(row_index.size()));
        }
    }
    std::vector<int> order;
    order.reserve(count);
    for (const int v : vertex_order) {
        if (place[v] >= 0) order.push_back(place[v]);
    }
    const std::vector<int> sizes(count, 3);
    cholesky_.emplace(NodeGraph{{count, node_start, node_rows}, sizes},
                      SymmetricPattern{3 * count, column_start, row_index}, std::move(order));
    matrix_.resize(value_.size());
}

/// With the exact Hessian, which is in `sums`, or where that is not positive definite the Gauss-Newton form.
bool FabricRelaxation::solve(const Model& model, const Eigen::VectorXd& x, AssembledSums& sums,
                             const Eigen::VectorXd& pull, Eigen::VectorXd& displacement) {
    const auto solve_part = [&] {
        for (std::size_t i = 0; i < value_.size(); ++i) matrix_[i] = sums.hessian[value_[i]];
        return cholesky_->factorize_and_solve(matrix_, pull, displacement);
    };
    if (solve_part()) return true;
    model.evaluate_fabric(x, Order::gauss_newton, sums);
    return solve_part();
}

void FabricRelaxation::operator()(const Model& model, Eigen::VectorXd& x, AssembledSums& scratch) {
    constexpr int most_steps = 3;
    constexpr double shortest = 0.01;
    if (!cholesky_) return;
    const auto count = static_cast<Eigen::Index>(unknowns_.size());
    AssembledSums none;
    bool whole = false;
    for (int step = 0; step < most_steps && !whole; ++step) {
        const double energy = model.evaluate_fabric(x, Order::hessian, scratch).total();
        if (!std::isfinite(energy)) return;
        Eigen::VectorXd gradient(count);
        for (Eigen::Index i = 0; i < count; ++i) gradient[i] = scratch.gradient[unknowns_[i]];
        Eigen::VectorXd direction;
        if (!solve(model, x, scratch, -gradient, direction)) return;
        const double slope = gradient.dot(direction);
        if (!direction.allFinite() || !(slope < 0.0)) return;
        Eigen::VectorXd candidate = x;
        bool lower = false;
        for (double t = 1.0; t > shortest && !lower; t *= 0.5) {
            for (Eigen::Index i = 0; i < count; ++i)
                candidate[unknowns_[i]] = x[unknowns_[i]] + t * direction[i];
            const double trial = model.evaluate_fabric(candidate, Order::value, none).total();
            lower = std::isfinite(trial) && trial <= energy + 1e-4 * t * slope;
            whole = lower && t == 1.0;
        }
        if (!lower) return;
        x = candidate;
    }
}

}  // namespace ruche
