#include "ruche/statics/fabric_relaxation.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <vector>

#include "energy/samples.hpp"
#include "ruche/statics/equilibrium.hpp"

using namespace ruche;
using namespace ruche::test;

namespace {

struct Sagging {
    Model model;
    std::vector<char> held;
    std::vector<int> order;
    std::vector<char> bare;  // per vertex: no printed triangle has it
    Eigen::VectorXd rest;
    Eigen::VectorXd x;  // bare vertices out of place

    explicit Sagging(const ModelInput& input)
        : model(input),
          held(model.size(), 0),
          order(vertex_elimination_order(model.pattern())),
          bare(model.vertex_count(), 1),
          rest(solve(model).x),
          x(rest) {
        for (int t = 0; t < input.mesh.triangle_count(); ++t) {
            for (const int v : input.mesh.triangles[t])
                bare[v] = bare[v] != 0 && input.print[t].bare() ? 1 : 0;
        }
        for (int v = 0; v < model.vertex_count(); ++v) {
            if (bare[v] != 0) x.segment<3>(3 * v) += 0.05 * Vec3(v % 3 - 1, v % 5 - 2, v % 7 - 3);
        }
    }
    double largest_force_on_bare(const Eigen::VectorXd& at) const {
        const Eigen::VectorXd gradient = model.gradient(at);
        double largest = 0.0;
        for (int v = 0; v < model.vertex_count(); ++v) {
            if (bare[v] != 0) largest = std::max(largest, gradient.segment<3>(3 * v).norm());
        }
        return largest;
    }
};

}  // namespace

TEST_CASE("model: what bare vertices feel is the energy of the fabric alone") {
    const Sagging sheet(two_strips());
    AssembledSums all;
    AssembledSums fabric;
    const EnergyTerms of_all = sheet.model.evaluate(sheet.x, Order::hessian, all);
    const EnergyTerms of_fabric = sheet.model.evaluate_fabric(sheet.x, Order::hessian, fabric);
    CHECK(of_fabric.fabric_membrane == of_all.fabric_membrane);
    CHECK(of_fabric.fabric_bending == of_all.fabric_bending);
    CHECK(of_fabric.total() == of_all.fabric_membrane + of_all.fabric_bending);
    const NodePattern& pattern = sheet.model.pattern();
    int bare = 0;
    for (int v = 0; v < sheet.model.vertex_count(); ++v) {
        if (sheet.bare[v] == 0) continue;
        ++bare;
        CHECK(fabric.gradient.segment<3>(3 * v) == all.gradient.segment<3>(3 * v));
        const int block = pattern.block_offset(v, v);
        CHECK(fabric.hessian[block] == all.hessian[block]);
    }
    CHECK(bare > 100);
}

TEST_CASE("fabric relaxation: fabric goes back to where it was at rest and strips stay") {
    const Sagging sheet(two_strips());
    FabricRelaxation relax(sheet.model, sheet.held, sheet.order);
    AssembledSums scratch;
    Eigen::VectorXd x = sheet.x;
    REQUIRE(sheet.largest_force_on_bare(x) > 1e-3);
    double force = sheet.largest_force_on_bare(x);
    for (int round = 0; round < 12 && force > 1e-9; ++round) {
        const double energy = sheet.model.energy(x);
        relax(sheet.model, x, scratch);
        CHECK(sheet.model.energy(x) < energy + 1e-14 * energy);
        force = sheet.largest_force_on_bare(x);
    }
    CHECK(force < 1e-9);
    CHECK((x - sheet.rest).cwiseAbs().maxCoeff() < 1e-5);
    for (int v = 0; v < sheet.model.vertex_count(); ++v) {
        if (sheet.bare[v] == 0) CHECK(x.segment<3>(3 * v) == sheet.rest.segment<3>(3 * v));
    }
    const Eigen::Index edges = x.size() - 3 * sheet.model.vertex_count();
    REQUIRE(edges > 0);
    CHECK(x.tail(edges) == sheet.rest.tail(edges));
}

TEST_CASE("fabric relaxation: what is held stays") {
    const Sagging sheet(two_strips());
    std::vector<char> held = sheet.held;
    int pinned = 0;
    while (sheet.bare[pinned] == 0) ++pinned;
    held[3 * pinned + 2] = 1;
    Eigen::VectorXd x = sheet.x;
    AssembledSums scratch;
    FabricRelaxation(sheet.model, held, sheet.order)(sheet.model, x, scratch);
    CHECK(x.segment<3>(3 * pinned) == sheet.x.segment<3>(3 * pinned));
    CHECK(x != sheet.x);
}

TEST_CASE("fabric relaxation: a vertex that no triangle has does not get in the way") {
    const Sagging sheet(two_strips());
    ModelInput input = two_strips();
    input.mesh.vertices.emplace_back(50.0, 50.0);
    const Model model(input);
    const Eigen::Index positions = 3 * sheet.model.vertex_count();
    Eigen::VectorXd start(sheet.x.size() + 3);
    start << sheet.x.head(positions), 50.0, 50.0, 0.0, sheet.x.tail(sheet.x.size() - positions);
    Eigen::VectorXd x = start;
    AssembledSums scratch;
    FabricRelaxation(model, std::vector<char>(model.size(), 0), vertex_elimination_order(model.pattern()))(
        model, x, scratch);
    CHECK(model.energy(x) < model.energy(start));
    CHECK(x.segment<3>(positions) == start.segment<3>(positions));
}

TEST_CASE("fabric relaxation: without strips, without fabric and from an impossible shape nothing moves") {
    AssembledSums scratch;
    for (const double thickness : {0.0, 0.8}) {
        ModelInput input = two_strips();
        for (Print& print : input.print) print.front = thickness;
        const Model model(input);
        const Eigen::VectorXd start = model.initial();
        Eigen::VectorXd x = start;
        FabricRelaxation(model, std::vector<char>(model.size(), 0),
                         vertex_elimination_order(model.pattern()))(model, x, scratch);
        CHECK(x == start);
    }
    const Sagging sheet(two_strips());
    Eigen::VectorXd crushed = sheet.x;
    crushed.head(3 * sheet.model.vertex_count()).setZero();
    const Eigen::VectorXd start = crushed;
    FabricRelaxation(sheet.model, sheet.held, sheet.order)(sheet.model, crushed, scratch);
    CHECK(crushed == start);
}
