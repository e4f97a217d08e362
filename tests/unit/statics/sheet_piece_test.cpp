#include "ruche/statics/sheet_piece.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "energy/samples.hpp"
#include "ruche/statics/bending_places.hpp"

using namespace ruche;
using namespace ruche::test;

namespace {

ModelInput sheet_with_a_strip() {
    ModelInput sheet;
    sheet.mesh = random_grid(12, 12, 0.2, 3);
    for (const Triangle& t : sheet.mesh.triangles) {
        const double x =
            (sheet.mesh.vertices[t[0]].x() + sheet.mesh.vertices[t[1]].x() + sheet.mesh.vertices[t[2]].x()) /
            3.0;
        sheet.print.push_back({.front = x > 4 && x < 8 ? 0.6 : 0.0});
    }
    sheet.prestretch = {1.3, 1.4};
    return sheet;
}

Eigen::VectorXd wavy(const Model& model) {
    Eigen::VectorXd x = model.initial();
    for (Eigen::Index i = 0; i < x.size(); ++i) x[i] += 0.05 * std::sin(1.7 * static_cast<double>(i));
    return x;
}

}  // namespace

TEST_CASE("sheet piece: what is free feels the forces that it feels in the whole sheet") {
    const Model whole(sheet_with_a_strip());
    const Eigen::VectorXd x = wavy(whole);
    const SheetPiece piece = cut_out(whole, std::vector<int>{40, 41, 42, 53, 54}, x);
    const Eigen::VectorXd y = piece.take(x);
    const Eigen::VectorXd forces = whole.gradient(x);
    const Eigen::VectorXd own = piece.model.gradient(y);
    int free = 0;
    for (Eigen::Index i = 0; i < own.size(); ++i) {
        if (piece.held[static_cast<std::size_t>(i)] != 0) continue;
        ++free;
        CHECK(own[i] == doctest::Approx(forces[piece.unknowns[static_cast<std::size_t>(i)]]).epsilon(1e-10));
    }
    CHECK(free > 15);
    CHECK(free < piece.model.size());
}

TEST_CASE("sheet piece: moving what is free changes both energies alike, and nothing else moves") {
    const Model whole(sheet_with_a_strip());
    const Eigen::VectorXd x = wavy(whole);
    const SheetPiece piece = cut_out(whole, std::vector<int>{40, 41, 42, 53, 54}, x);
    Eigen::VectorXd y = piece.take(x);
    const double before = piece.model.energy(y);
    for (Eigen::Index i = 0; i < y.size(); ++i) y[i] += 0.02 * std::cos(static_cast<double>(i));
    Eigen::VectorXd moved = x;
    piece.place(y, moved);
    const double change = piece.model.energy(piece.take(moved)) - before;
    CHECK(change == doctest::Approx(whole.energy(moved) - whole.energy(x)).epsilon(1e-9));
    CHECK((moved - x).cwiseAbs().maxCoeff() > 0.01);
    const auto free = std::count(piece.held.begin(), piece.held.end(), 0);
    CHECK(((moved - x).array() != 0.0).count() <= free);
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
