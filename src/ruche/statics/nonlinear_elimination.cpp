#include "ruche/statics/nonlinear_elimination.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "ruche/core/parallel.hpp"

namespace ruche {
namespace {

constexpr double concentrated = 0.1;  // of the largest force on a vertex: belongs to a spot
constexpr double most_vertices =
    0.03;  // share of the vertices that may; when more would, the hardest of them
constexpr std::size_t most_nodes = 400;  // of one spot: more is no spot, and its dense factor would be dear
constexpr int most_steps = 8;
constexpr int rings_thrown_off = 2;  // of vertices around a spot that a step has thrown off
constexpr std::size_t most_nodes_with_rings = 150;
constexpr double most_with_rings = 0.05;  // share of all nodes
constexpr double good_enough = 0.01;      // of the spot's first residual: its surroundings will move too

Eigen::VectorXd gather(const Model::Patch& patch, const Eigen::VectorXd& x) {
    Eigen::VectorXd values(patch.size());
    for (int i = 0; i < patch.size(); ++i) values[i] = x[patch.unknowns()[i]];
    return values;
}

void place(const Model::Patch& patch, const Eigen::VectorXd& values, Eigen::VectorXd& x) {
    for (int i = 0; i < patch.size(); ++i) x[patch.unknowns()[i]] = values[i];
}

/// Newton's method on a spot: exact Hessian, shifted until it is positive definite, Armijo's rule. Returns
/// by how much the energy fell.
double relax(const Model& model, const Model::Patch& patch, Eigen::VectorXd& x) {
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
        const Eigen::VectorXd from = gather(patch, x);
        bool lower = false;
        for (double t = 1.0; t > 1e-6 && !lower; t *= 0.5) {
            place(patch, from + t * direction, x);
            const double trial = model.evaluate(patch, x, Order::value, none);
            lower = std::isfinite(trial) && trial <= energy + 1e-4 * t * slope;
            if (lower) fell += energy - trial;
        }
        if (!lower) {
            place(patch, from, x);
            break;
        }
    }
    return fell;
}

}  // namespace

NonlinearElimination::NonlinearElimination(const Model& model, const std::vector<char>& held)
    : held_(held),
      triangles_of_vertex_(model.vertex_count()),
      edge_unknowns_of_vertex_(model.vertex_count()),
      force_(model.vertex_count()),
      parent_(model.pattern().node_count()) {
    const TriangleMesh& mesh = model.input().mesh;
    for (int t = 0; t < mesh.triangle_count(); ++t) {
        for (const int v : mesh.triangles[t]) triangles_of_vertex_[v].push_back(t);
    }
    for (int node = model.vertex_count(); node < model.pattern().node_count(); ++node) {
        const std::array<int, 4> around = model.vertices_of_edge_unknown(node - model.vertex_count());
        for (int end = 0; end < 2; ++end) edge_unknowns_of_vertex_[around[end]].push_back(node);
    }
}

NonlinearElimination::ForceRange NonlinearElimination::measure_forces(const Eigen::VectorXd& gradient) {
    const auto vertices = static_cast<Eigen::Index>(force_.size());
    for (Eigen::Index v = 0; v < vertices; ++v) force_[v] = gradient.segment<3>(3 * v).norm();
    std::vector<double> sorted = force_;
    const auto hardest = sorted.begin() + static_cast<std::ptrdiff_t>((1.0 - most_vertices) * vertices);
    std::nth_element(sorted.begin(), hardest, sorted.end());
    return {.largest = *std::max_element(hardest, sorted.end()), .of_hardest = *hardest};
}

bool NonlinearElimination::is_concentrated(const Eigen::VectorXd& gradient) {
    const ForceRange force = measure_forces(gradient);
    return force.of_hardest < concentrated * force.largest;
}

/// Above it a vertex belongs to a spot: a large part of the largest force, or `much`.
double NonlinearElimination::limiting_force(const Eigen::VectorXd& gradient, double much) {
    const ForceRange force = measure_forces(gradient);
    return std::max(std::min(concentrated * force.largest, much), force.of_hardest);
}

/// Nodes of each spot: vertices whose force, measured last, is above `limit`, `rings` of vertices around
/// them, and the edge unknowns at all of these, joined where an element touches both.
std::vector<std::vector<int>> NonlinearElimination::spots(const Model& model, double limit, int rings) {
    const NodePattern& pattern = model.pattern();
    const int vertices = pattern.vertex_count();
    std::fill(parent_.begin(), parent_.end(), -1);
    const auto take = [&](int v) {
        parent_[v] = v;
        for (const int node : edge_unknowns_of_vertex_[v]) parent_[node] = node;
    };
    std::vector<int> border;
    for (int v = 0; v < vertices; ++v) {
        if (!(force_[v] > limit)) continue;
        take(v);
        border.push_back(v);
    }
    for (int ring = 0; ring < rings; ++ring) {
        std::vector<int> next;
        for (const int v : border) {
            for (const int t : triangles_of_vertex_[v]) {
                for (const int other : model.input().mesh.triangles[t]) {
                    if (parent_[other] >= 0) continue;
                    take(other);
                    next.push_back(other);
                }
            }
        }
        border = std::move(next);
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
    found.reserve(by_root.size());
    for (auto& [first, nodes] : by_root) found.push_back(std::move(nodes));
    return found;
}

/// Moves the vertices of a spot to where they would be had they moved from `from` as their surroundings have,
/// by the harmonic continuation of that displacement on the layout; edge unknowns go back to those of `from`.
void NonlinearElimination::carry_along(const Model& model, const std::vector<int>& nodes,
                                       const Eigen::VectorXd& from, Eigen::VectorXd& x) const {
    const TriangleMesh& mesh = model.input().mesh;
    std::map<int, int> row_of;
    std::vector<int> triangles;
    for (const int node : nodes) {
        if (node >= model.vertex_count()) continue;
        row_of.emplace(node, static_cast<int>(row_of.size()));
        const std::vector<int>& around = triangles_of_vertex_[node];
        triangles.insert(triangles.end(), around.begin(), around.end());
    }
    std::sort(triangles.begin(), triangles.end());
    triangles.erase(std::unique(triangles.begin(), triangles.end()), triangles.end());
    const auto size = static_cast<Eigen::Index>(row_of.size());
    Eigen::MatrixXd laplacian = Eigen::MatrixXd::Zero(size, size);
    Eigen::MatrixXd pull = Eigen::MatrixXd::Zero(size, 3);
    for (const int t : triangles) {
        const Triangle& v = mesh.triangles[t];
        const Eigen::Matrix<double, 2, 3> hats = hat_gradients(mesh, t);
        const Mat3 local = layout_area(mesh, t) * (hats.transpose() * hats);
        for (int i = 0; i < 3; ++i) {
            const auto row = row_of.find(v[i]);
            if (row == row_of.end()) continue;
            for (int j = 0; j < 3; ++j) {
                const auto column = row_of.find(v[j]);
                if (column != row_of.end()) {
                    laplacian(row->second, column->second) += local(i, j);
                } else {
                    const Eigen::Index at = 3 * static_cast<Eigen::Index>(v[j]);
                    pull.row(row->second) -=
                        local(i, j) * (x.segment<3>(at) - from.segment<3>(at)).transpose();
                }
            }
        }
    }
    const Eigen::LLT<Eigen::MatrixXd> factor(laplacian);
    if (factor.info() != Eigen::Success) return;
    const Eigen::MatrixXd displacement = factor.solve(pull);
    for (const auto& [vertex, row] : row_of) {
        const Eigen::Index at = 3 * static_cast<Eigen::Index>(vertex);
        for (int c = 0; c < 3; ++c) {
            if (!held_[at + c]) x[at + c] = from[at + c] + displacement(row, c);
        }
    }
    for (const int node : nodes) {
        const int unknown = model.pattern().first_unknown(node);
        if (node >= model.vertex_count()) x[unknown] = from[unknown];
    }
}

double NonlinearElimination::relax_spots(const Model& model, std::vector<std::vector<int>> spots,
                                         const Eigen::VectorXd* from, Eigen::VectorXd& x,
                                         Eigen::VectorXd& gradient) const {
    std::erase_if(spots, [](const std::vector<int>& nodes) { return nodes.size() > most_nodes; });
    std::vector<Model::Patch> patches;
    patches.reserve(spots.size());
    for (const std::vector<int>& nodes : spots) patches.push_back(model.patch(nodes, held_));
    for (const Model::Patch& patch : patches) model.add_gradient(patch, x, -1.0, gradient);
    std::vector<double> fell(patches.size());
    // No element touches two spots: they do not see each other move.
    parallel_for(patches.size(), [&](std::size_t i) {
        if (from != nullptr) {
            DenseSums none;
            const Eigen::VectorXd thrown = gather(patches[i], x);
            const double energy = model.evaluate(patches[i], x, Order::value, none);
            carry_along(model, spots[i], *from, x);
            const double carried = model.evaluate(patches[i], x, Order::value, none);
            if (carried < energy) {
                fell[i] = energy - carried;
            } else {
                place(patches[i], thrown, x);
            }
        }
        fell[i] += relax(model, patches[i], x);
    });
    for (const Model::Patch& patch : patches) model.add_gradient(patch, x, 1.0, gradient);
    for (Eigen::Index i = 0; i < gradient.size(); ++i) {
        if (held_[i]) gradient[i] = 0.0;
    }
    return std::accumulate(fell.begin(), fell.end(), 0.0);
}

/// Spots with so many rings of vertices around them as stay cheap.
std::vector<std::vector<int>> NonlinearElimination::spots_with_rings(const Model& model, double limit,
                                                                     int rings) {
    for (;; --rings) {
        std::vector<std::vector<int>> found = spots(model, limit, rings);
        std::size_t largest = 0;
        std::size_t all = 0;
        for (const std::vector<int>& nodes : found) {
            largest = std::max(largest, nodes.size());
            all += nodes.size();
        }
        // On a coarse mesh the surroundings of a few spots are soon the whole sheet.
        if (rings == 0 || (largest <= most_nodes_with_rings &&
                           static_cast<double>(all) <= most_with_rings * model.pattern().node_count()))
            return found;
    }
}

double NonlinearElimination::operator()(const Model& model, Eigen::VectorXd& x, Eigen::VectorXd& gradient,
                                        int rings) {
    return relax_spots(model, spots_with_rings(model, limiting_force(gradient, infinity), rings), nullptr, x,
                       gradient);
}

double NonlinearElimination::after_step(const Model& model, const Eigen::VectorXd& from, double much,
                                        Eigen::VectorXd& x, Eigen::VectorXd& gradient) {
    return relax_spots(model, spots_with_rings(model, limiting_force(gradient, much), rings_thrown_off),
                       &from, x, gradient);
}

}  // namespace ruche
