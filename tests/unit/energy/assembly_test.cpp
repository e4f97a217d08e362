#include "ruche/energy/assembly.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "energy/battery.hpp"
#include "energy/samples.hpp"
#include "ruche/energy/fabric_membrane.hpp"

using namespace ruche;
using namespace ruche::test;

TEST_CASE("assembly: more blocks around one vertex than there are colours sum to the same bits") {
    constexpr int count = 9000;  // 71 blocks of 128 elements, 63 colours
    std::vector<FabricMembrane::Element> elements;
    std::vector<Vec2> rim;
    for (int k = 0; k < count; ++k) {
        const double angle = 2.0 * std::numbers::pi * k / count;
        rim.emplace_back(100.0 * std::cos(angle), 100.0 * std::sin(angle));
    }
    for (int k = 0; k < count; ++k) {
        const int next = (k + 1) % count;
        elements.push_back({{0, 1 + k, 1 + next}, {Vec2(0.0, 0.0), rim[k], rim[next]}});
    }
    TermAssembly<FabricMembrane> assembly(FabricMembrane(FabricLaw(Material{}), 0.46, elements));
    const NodePattern::Cliques cliques[] = {assembly.cliques()};
    const NodePattern pattern(count + 1, 0, cliques);
    assembly.prepare(std::make_shared<NodePattern>(pattern));
    Eigen::VectorXd x(3 * (count + 1));
    x.head<3>() << 3.0, 1.0, 20.0;
    for (int k = 0; k < count; ++k) x.segment<3>(3 * (k + 1)) << 1.1 * rim[k].x(), 1.2 * rim[k].y(), 0.0;
    const auto assemble = [&]() -> Sums {
        AssembledSums sums;
        sums.gradient.setZero(x.size());
        sums.hessian.assign(pattern.row_index().size(), 0.0);
        const double value = assembly.add({x.data(), count + 1}, Order::hessian, sums);
        return {value, sums.gradient,
                Eigen::Map<const Eigen::VectorXd>(sums.hessian.data(), Eigen::Index(sums.hessian.size()))};
    };
    check_thread_independent(assemble);

    Sums plain{0.0, Eigen::VectorXd::Zero(x.size()), Eigen::MatrixXd()};
    Mat3 hub = Mat3::Zero();
    for (int e = 0; e < count; ++e) {
        const Local<9> local = assembly.term().evaluate(e, {x.data(), count + 1}, Order::hessian);
        plain.value += local.value;
        hub += local.hessian.topLeftCorner<3, 3>();
        for (int i = 0; i < 3; ++i) {
            plain.gradient.segment<3>(3 * elements[e].vertices[i]) += local.gradient.segment<3>(3 * i);
        }
    }
    const Sums sums = assemble();
    CHECK(sums.value == doctest::Approx(plain.value).epsilon(1e-13));
    CHECK((sums.gradient - plain.gradient).norm() <= 1e-12 * plain.gradient.norm());
    const int first = pattern.block_offset(0, 0);
    for (int c = 0; c < 3; ++c) {
        for (int r = 0; r < 3; ++r) {
            CHECK(std::abs(sums.hessian(first + r + c * pattern.column_length(0)) - hub(r, c)) <=
                  1e-12 * hub.norm());
        }
    }
}

TEST_CASE("node pattern: blocks of every clique and nothing else, lower triangle, sorted columns") {
    // Three vertices and two edge unknowns (nodes 3, 4); vertex 2 appears in no clique, and one twice in one.
    const NodePattern::Cliques cliques[] = {{.nodes = {0, 1, 3, 1, -1, 4}, .width = 3},
                                            {.nodes = {1, 1}, .width = 2}};
    const NodePattern pattern(3, 2, cliques);
    CHECK(pattern.node_count() == 5);
    CHECK(pattern.unknown_count() == 11);
    const bool joined[5][5] = {{true, true, false, true, false},
                               {true, true, false, true, true},
                               {false, false, true, false, false},
                               {true, true, false, true, false},
                               {false, true, false, false, true}};
    std::size_t entries = 0;
    for (int column = 0; column < 5; ++column) {
        for (int row = column; row < 5; ++row) {
            if (!joined[row][column]) continue;
            entries += std::size_t(pattern.node_size(row)) * pattern.node_size(column);
            for (int c = 0; c < pattern.node_size(column); ++c) {
                for (int r = 0; r < pattern.node_size(row); ++r) {
                    const int at = pattern.block_offset(row, column) + r + c * pattern.column_length(column);
                    CHECK(pattern.row_index()[at] == pattern.first_unknown(row) + r);
                    const int stored_column = pattern.first_unknown(column) + c;
                    CHECK(pattern.column_start()[stored_column] <= at);
                    CHECK(at < pattern.column_start()[stored_column + 1]);
                }
            }
        }
    }
    CHECK(pattern.row_index().size() == entries);
}
