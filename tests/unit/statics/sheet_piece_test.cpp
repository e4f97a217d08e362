#include "ruche/statics/sheet_piece.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <vector>

#include "energy/samples.hpp"
#include "ruche/statics/bending_places.hpp"
#include "ruche/statics/equilibrium.hpp"
#include "ruche/statics/newton.hpp"

using namespace ruche;
using namespace ruche::test;

namespace {

/// Vertices of the layout around the middle of the first of the two strips.
std::vector<int> middle_of_a_strip(const ModelInput& sheet) {
    std::vector<int> near;
    for (int v = 0; v < sheet.mesh.vertex_count(); ++v) {
        if ((sheet.mesh.vertices[v] - Vec2(5.0, 8.0)).norm() < 2.0) near.push_back(v);
    }
    return near;
}

/// The two strips with every choice that decides which edges have unknowns; the cut goes across a strip,
/// where the piece has rims that the sheet has not.
std::vector<ModelInput> sheets() {
    std::vector<ModelInput> result;
    for (const EdgeNormals normals : {EdgeNormals::free, EdgeNormals::averaged}) {
        for (const FabricPlyLaw law : {FabricPlyLaw::linear, FabricPlyLaw::same_law}) {
            result.push_back(two_strips());
            result.back().options.edge_normals = normals;
            result.back().options.fabric_ply = law;
            result.back().gravity = {0.0, 0.0, -9810.0};
        }
    }
    return result;
}

}  // namespace

TEST_CASE("sheet piece: what is free feels the forces that it feels in the whole sheet") {
    for (const ModelInput& sheet : sheets()) {
        const Model whole(sheet);
        const Eigen::VectorXd x = rolled(whole, {});
        const SheetPiece piece = cut_out(whole, middle_of_a_strip(sheet), x);
        const Eigen::VectorXd forces = whole.gradient(x);
        const Eigen::VectorXd own = piece.model.gradient(piece.take(x));
        int free = 0;
        for (Eigen::Index i = 0; i < own.size(); ++i) {
            if (piece.held[static_cast<std::size_t>(i)] != 0) continue;
            ++free;
            CHECK(own[i] ==
                  doctest::Approx(forces[piece.unknowns[static_cast<std::size_t>(i)]]).epsilon(1e-9));
        }
        CHECK(free >= 30);
        CHECK(2 * free < piece.model.size());
        CHECK(piece.model.size() < whole.size());
    }
}

TEST_CASE("sheet piece: moving what is free changes both energies alike, and nothing else moves") {
    for (const ModelInput& sheet : sheets()) {
        const Model whole(sheet);
        const Eigen::VectorXd x = rolled(whole, {});
        const SheetPiece piece = cut_out(whole, middle_of_a_strip(sheet), x);
        Eigen::VectorXd y = piece.take(x);
        const double before = piece.model.energy(y);
        for (Eigen::Index i = 0; i < y.size(); ++i) {
            if (piece.held[static_cast<std::size_t>(i)] == 0) y[i] += 0.02 * std::cos(static_cast<double>(i));
        }
        Eigen::VectorXd moved = x;
        piece.place(y, moved);
        const double change = whole.energy(moved) - whole.energy(x);
        CHECK(std::abs(change) > 1e-3);
        CHECK(piece.model.energy(y) - before == doctest::Approx(change).epsilon(1e-8));
        CHECK(((moved - x).array() != 0.0).count() == std::count(piece.held.begin(), piece.held.end(), 0));
    }
}

TEST_CASE("sheet piece: it settles inside its rim, and not at all after a stop") {
    const ModelInput sheet = two_strips();
    const Model whole(sheet);
    const Eigen::VectorXd rest = solve(whole).x;
    Eigen::VectorXd x = rest;
    for (const int v : middle_of_a_strip(sheet))
        x.segment<3>(3 * v) += 0.03 * Vec3(v % 3 - 1, v % 5 - 2, v % 7 - 3);
    const SheetPiece piece = cut_out(whole, middle_of_a_strip(sheet), x);
    const Eigen::VectorXd y = piece.take(x);
    const Control quiet;
    const Eigen::VectorXd settled = Newton(piece, false, {}, quiet).settle(y);
    CHECK((settled - y).cwiseAbs().maxCoeff() > 0.02);
    CHECK((settled - piece.take(rest)).cwiseAbs().maxCoeff() < 1e-3);
    for (Eigen::Index i = 0; i < y.size(); ++i) {
        if (piece.held[static_cast<std::size_t>(i)] != 0) CHECK(settled[i] == y[i]);
    }
    const std::atomic<bool> stop = true;
    Control stopped;
    stopped.stop = &stop;
    CHECK(Newton(piece, false, {}, stopped).settle(y) == y);
}

TEST_CASE("bending places: one fold is one place, a bend all over or a turn of the whole is none") {
    ModelInput sheet;
    sheet.mesh = random_grid(40, 40, 0.2, 3);
    sheet.print.assign(sheet.mesh.triangles.size(), Print{});
    const Model model(sheet);
    const std::vector<char> held(model.size(), 0);
    std::vector<Vec3> spins(sheet.mesh.triangles.size(), Vec3(0.3, 0.0, 0.0));
    CHECK(bending_places(model, held, spins).empty());
    const Triangle folded = sheet.mesh.triangles[1600];
    spins[1600] += Vec3(0.0, 0.5, 0.0);
    const auto places = bending_places(model, held, spins);
    REQUIRE(places.size() == 1);
    for (const int v : folded) CHECK(std::count(places[0].begin(), places[0].end(), v) == 1);
    CHECK(places[0].size() < sheet.mesh.vertices.size() / 4);
    spins[1600] = Vec3(0.3, 1e-3, 0.0);
    CHECK(bending_places(model, held, spins).empty());  // hardly at all
    for (std::size_t t = 0; t < spins.size(); ++t) spins[t] = 0.1 * Vec3(std::sin(3.0 * t), 0.0, 0.0);
    CHECK(bending_places(model, held, spins).empty());
}
