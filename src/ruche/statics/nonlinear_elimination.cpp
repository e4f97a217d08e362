#include "ruche/statics/nonlinear_elimination.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "ruche/core/parallel.hpp"

namespace ruche {
namespace {

constexpr double concentrated = 0.1;  // of the largest force on a vertex: belongs to a spot
constexpr double most_vertices =
    0.03;  // share of the vertices that may; when more would, the hardest of them
constexpr std::size_t most_nodes = 400;  // of one spot: more is no spot, and its dense factor would be dear
constexpr int most_steps = 8;
constexpr double good_enough = 0.01;  // of the spot's first residual: its surroundings will move too

/// Newton's method on a spot: exact Hessian, shifted until it is positive definite, Armijo's rule. Returns
/// by how much the energy fell.
double relax(const Model& model, const Model::Patch& patch, Eigen::VectorXd& x) {
    const auto gather = [&] {
        Eigen::VectorXd values(patch.size());
        for (int i = 0; i < patch.size(); ++i) values[i] = x[patch.unknowns()[i]];
        return values;
    };
    const auto place = [&](const Eigen::VectorXd& values) {
        for (int i = 0; i < patch.size(); ++i) x[patch.unknowns()[i]] = values[i];
    };
    DenseSums sums;
    DenseSums none;
    Eigen::LLT<Eigen::MatrixXd> factor;
    double fell = 0.0;
    double first_residual = 0.0;
    for (int step = 0; step < most_steps; ++step) {
        const double energy = model.evaluate(patch, x, Order::hessian, sums);
        const double residual = sums.gradient.cwiseAbs().maxCoeff();
        if (step == 0) first_residual = residual;
        if (!std::isfinite(energy) || !(residual > good_enough * first_residual)) break;
        factor.compute(sums.hessian);
        double shift = 1e-3 * sums.hessian.diagonal().cwiseAbs().mean();
        for (int attempt = 0; factor.info() != Eigen::Success && attempt < 20; ++attempt, shift *= 4.0) {
            sums.hessian.diagonal().array() += shift;
            factor.compute(sums.hessian);
        }
        const Eigen::VectorXd direction = factor.solve(-sums.gradient);
        const double slope = sums.gradient.dot(direction);
        if (!(slope < 0.0) || !direction.allFinite()) break;
        const Eigen::VectorXd from = gather();
        bool lower = false;
        for (double t = 1.0; t > 1e-6 && !lower; t *= 0.5) {
            place(from + t * direction);
            const double trial = model.evaluate(patch, x, Order::value, none);
            lower = std::isfinite(trial) && trial <= energy + 1e-4 * t * slope;
            if (lower) fell += energy - trial;
        }
        if (!lower) {
            place(from);
            break;
        }
    }
    return fell;
}

}  // namespace

NonlinearElimination::NonlinearElimination(const Model& model, const std::vector<char>& held)
    : held_(held),
      edge_unknowns_of_vertex_(model.vertex_count()),
      force_(model.vertex_count()),
      parent_(model.pattern().node_count()) {
    for (int node = model.vertex_count(); node < model.pattern().node_count(); ++node) {
        const std::array<int, 4> around = model.vertices_of_edge_unknown(node - model.vertex_count());
        for (int end = 0; end < 2; ++end) edge_unknowns_of_vertex_[around[end]].push_back(node);
    }
}

/// Nodes of each spot: vertices under a large part of the largest force or under `much`, and the edge
/// unknowns at them, joined where an element touches both.
std::vector<std::vector<int>> NonlinearElimination::spots(const NodePattern& pattern,
                                                          const Eigen::VectorXd& gradient, double much) {
    const int vertices = pattern.vertex_count();
    for (int v = 0; v < vertices; ++v) force_[v] = gradient.segment<3>(3 * v).norm();
    std::vector<double> sorted = force_;
    const auto quantile = sorted.begin() + static_cast<std::ptrdiff_t>((1.0 - most_vertices) * vertices);
    std::nth_element(sorted.begin(), quantile, sorted.end());
    const double largest = *std::max_element(quantile, sorted.end());
    const double limit = std::max(std::min(concentrated * largest, much), *quantile);

    std::fill(parent_.begin(), parent_.end(), -1);
    for (int v = 0; v < vertices; ++v) {
        if (!(force_[v] > limit)) continue;
        parent_[v] = v;
        for (const int node : edge_unknowns_of_vertex_[v]) parent_[node] = node;
    }
    const auto root = [&](int node) {
        while (parent_[node] != node) node = parent_[node] = parent_[parent_[node]];
        return node;
    };
    for (int node = 0; node < pattern.node_count(); ++node) {
        if (parent_[node] < 0) continue;
        for (const int other : pattern.rows_of(node)) {
            if (parent_[other] >= 0) parent_[root(other)] = root(node);
        }
    }
    std::map<int, std::vector<int>> by_root;
    for (int node = 0; node < pattern.node_count(); ++node) {
        if (parent_[node] >= 0) by_root[root(node)].push_back(node);
    }
    std::vector<std::vector<int>> found;
    for (auto& [first, nodes] : by_root) {
        if (nodes.size() <= most_nodes) found.push_back(std::move(nodes));
    }
    return found;
}

double NonlinearElimination::operator()(const Model& model, Eigen::VectorXd& x, Eigen::VectorXd& gradient,
                                        double much) {
    std::vector<Model::Patch> patches;
    for (const std::vector<int>& nodes : spots(model.pattern(), gradient, much))
        patches.push_back(model.patch(nodes, held_));
    for (const Model::Patch& patch : patches) model.add_gradient(patch, x, -1.0, gradient);
    std::vector<double> fell(patches.size());
    // No element touches two spots: they do not see each other move.
    parallel_for(patches.size(), [&](std::size_t i) { fell[i] = relax(model, patches[i], x); });
    for (const Model::Patch& patch : patches) model.add_gradient(patch, x, 1.0, gradient);
    for (Eigen::Index i = 0; i < gradient.size(); ++i) {
        if (held_[i]) gradient[i] = 0.0;
    }
    return std::accumulate(fell.begin(), fell.end(), 0.0);
}

}  // namespace ruche
