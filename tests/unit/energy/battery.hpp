#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <functional>
#include <random>
#include <string>

#include "ruche/energy/model.hpp"
#include "ruche/energy/term.hpp"

/// What every term of the energy, and the whole model, must satisfy.
namespace ruche::test {

/// Value, gradient and Hessian of a function of all unknowns, dense.
struct Sums {
    double value = 0.0;
    Eigen::VectorXd gradient;
    Eigen::MatrixXd hessian;
};

/// An energy as the battery sees it: unknowns are positions (three per vertex), then edge unknowns.
struct Energy {
    int vertex_count = 0;
    int size = 0;
    std::function<Sums(const Eigen::VectorXd&, Order)> evaluate;

    double value(const Eigen::VectorXd& x) const { return evaluate(x, Order::value).value; }
    Eigen::VectorXd gradient(const Eigen::VectorXd& x) const { return evaluate(x, Order::gradient).gradient; }
};

/// The plain sum over a term's elements, without the product's assembly.
template <Term T>
Energy energy_of(const T& term, int vertex_count, int edge_unknowns) {
    const int size = 3 * vertex_count + edge_unknowns;
    return {vertex_count, size, [&term, vertex_count, size](const Eigen::VectorXd& x, Order order) {
                Sums sums{0.0, Eigen::VectorXd::Zero(size), Eigen::MatrixXd::Zero(size, size)};
                for (int e = 0; e < term.element_count(); ++e) {
                    const auto local = term.evaluate(e, {x.data(), vertex_count}, order);
                    sums.value += local.value;
                    const auto nodes = term.nodes(e);
                    std::vector<int> at(local.gradient.size(), -1);  // global unknown of each local one
                    for (int slot = 0; slot < int(nodes.size()); ++slot) {
                        if (nodes[slot] < 0) continue;
                        if (slot < T::vertex_slots) {
                            for (int c = 0; c < 3; ++c) at[3 * slot + c] = 3 * nodes[slot] + c;
                        } else {
                            at[2 * T::vertex_slots + slot] = 2 * vertex_count + nodes[slot];
                        }
                    }
                    for (int i = 0; i < int(at.size()); ++i) {
                        if (at[i] < 0) continue;
                        sums.gradient[at[i]] += local.gradient[i];
                        for (int j = 0; j < int(at.size()); ++j) {
                            if (at[j] >= 0)
                                sums.hessian(at[i], at[j]) += local.hessian(std::max(i, j), std::min(i, j));
                        }
                    }
                }
                return sums;
            }};
}
Energy energy_of(const Model& model);

/// A motion x -> rotation x + translation of all positions (a reflection when det = -1: then edge unknowns
/// change their sign, as the rotation of a normal about an edge does).
struct Motion {
    Mat3 rotation = Mat3::Identity();
    Vec3 translation = Vec3::Zero();

    Eigen::VectorXd operator()(const Energy& energy, const Eigen::VectorXd& x) const;
    /// The linear part alone: how a gradient moves.
    Eigen::VectorXd turn(const Energy& energy, const Eigen::VectorXd& gradient) const;
};
Motion random_motion(std::mt19937& random);
Motion turn_about_z(double angle, const Vec3& translation);
Motion mirror_z();

/// Central differences along random directions at steps h, h/2, ... h/16: extrapolated by Richardson they
/// agree with gradient and Hessian to 1e-8, and the plain ones approach them with order 2.
void check_derivatives(const Energy& energy, const Eigen::VectorXd& x, double step = 4e-3);
/// The same value and gradient, to the bit, at every Order that asks for them; the Hessian is symmetric; both
/// Gauss-Newton forms are positive semidefinite.
void check_orders(const Energy& energy, const Eigen::VectorXd& x);
/// Energy `moved` at the moved state equals `energy` at x; gradient and Hessian move along.
void check_invariance(const Energy& energy, const Energy& moved, const Motion& motion,
                      const Eigen::VectorXd& x);
/// Two energies agree in value, gradient and Hessian, relative to their largest components.
void check_same(const Sums& a, const Sums& b, double tolerance);

/// Derivatives, orders, and invariance under random rigid motions.
void check_battery(const Energy& energy, const Eigen::VectorXd& x, double step = 4e-3);

/// Calls `run` at 1, 2 and 5 threads and checks that its results are the same to the bit.
void check_thread_independent(const std::function<Sums()>& run);

/// The product's assembly of a term agrees with the plain sum and gives the same bits at any thread count.
template <Term T>
void check_assembly(const T& term, int vertex_count, int edge_unknowns, const Eigen::VectorXd& x) {
    TermAssembly<T> assembly(term);
    const NodePattern::Cliques cliques[] = {assembly.cliques()};
    const NodePattern pattern(vertex_count, edge_unknowns, cliques);
    assembly.prepare(std::make_shared<NodePattern>(pattern));
    const auto assemble = [&]() -> Sums {
        AssembledSums sums;
        sums.gradient.setZero(x.size());
        sums.hessian.assign(pattern.row_index().size(), 0.0);
        const double value = assembly.add({x.data(), vertex_count}, Order::hessian, sums);
        return {value, sums.gradient, pattern.full_matrix(sums.hessian).toDense()};
    };
    check_thread_independent(assemble);
    check_same(assemble(), energy_of(term, vertex_count, edge_unknowns).evaluate(x, Order::hessian), 1e-13);
}

}  // namespace ruche::test
