#include "ruche/statics/sheet_symmetry.hpp"

#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>

#include "ruche/geometry/layout_frame.hpp"
#include "ruche/meshing/structured.hpp"

using namespace ruche;

namespace {

/// A rectangle of 12 x 6 mm on an uneven mesh whose borders between print and fabric are lines of vertices.
ModelInput sheet(const std::function<Print(const Vec2&)>& print, MeshKind kind = MeshKind::alternating) {
    ModelInput input;
    input.mesh = rectangle_mesh(kind, {.length = 12, .width = 6, .across = 6});
    for (int t = 0; t < input.mesh.triangle_count(); ++t)
        input.print.push_back(print(layout_centroid(input.mesh, t)));
    return input;
}

Print all_over(const Vec2&) { return {.front = 0.4}; }
Print middle(const Vec2& p) { return {.front = std::abs(p.y() - 3.0) < 1.0 ? 0.4 : 0.0}; }
Print corner(const Vec2& p) { return {.front = p.x() < 4.0 && p.y() < 2.0 ? 0.4 : 0.0}; }
/// Front on the left half, back on the right.
Print halves(const Vec2& p) { return p.x() < 6.0 ? Print{.front = 0.4} : Print{.back = 0.4}; }

std::vector<std::string> names(const ModelInput& input) {
    std::vector<std::string> result;
    for (const SheetSymmetry& s : find_symmetries(input)) result.push_back(s.name);
    return result;
}
using Names = std::vector<std::string>;

/// A shape without any symmetry of its own.
Eigen::VectorXd bent(const Model& model) {
    Eigen::VectorXd x = Eigen::VectorXd::Zero(model.size());
    for (int v = 0; v < model.vertex_count(); ++v) {
        const Vec2& p = model.input().mesh.vertices[v];
        x.segment<3>(3 * v) << 0.9 * p.x() + 0.02 * p.y() * p.y(), 0.8 * p.y(),
            0.05 * p.x() * p.x() - 0.03 * p.x() * p.y() + 0.2 * std::sin(p.y());
    }
    return x;
}

}  // namespace

TEST_CASE("symmetry: strips along the middle have both mirrors and the half turn, a corner none") {
    CHECK(names(sheet(middle)) == Names{"turned by 180 degrees", "mirrored at the axis at 0 degrees",
                                        "mirrored at the axis at 90 degrees"});
    CHECK(names(sheet(corner)).empty());
}

TEST_CASE("symmetry: print that changes sides is mapped onto itself with the sides exchanged") {
    CHECK(names(sheet(halves)) == Names{"turned by 180 degrees, sides exchanged",
                                        "mirrored at the axis at 0 degrees",
                                        "mirrored at the axis at 90 degrees, sides exchanged"});
}

TEST_CASE("symmetry: bare fabric is also its own image with the sides exchanged") {
    CHECK(names(sheet([](const Vec2&) { return Print{}; })).size() == 7);
}

TEST_CASE("symmetry: fabric axes that lie askew break it where there is bare fabric, unless they are alike") {
    ModelInput askew = sheet(middle);
    askew.fabric_axis_deg = 20.0;
    CHECK(names(askew) == Names{"turned by 180 degrees"});
    ModelInput printed = sheet(all_over);
    printed.fabric_axis_deg = 20.0;
    CHECK(names(printed).size() == 3);  // the laminate is isotropic where both pre-stretches are equal
    printed.prestretch = {1.7, 1.6};
    CHECK(names(printed) == Names{"turned by 180 degrees"});
}

TEST_CASE("symmetry: a square of isotropic material has all eight, of the paper's fabric four") {
    ModelInput square;
    square.mesh = rectangle_mesh(MeshKind::criss_cross, {.length = 6, .width = 6, .across = 6});
    square.print.assign(square.mesh.triangles.size(), {});
    for (int t = 0; t < square.mesh.triangle_count(); ++t)
        if ((layout_centroid(square.mesh, t) - Vec2(3, 3)).cwiseAbs().maxCoeff() < 1.0)
            square.print[t].front = 0.5;
    CHECK(names(square).size() == 3);
    square.material.alpha_2 = square.material.alpha_1;
    square.material.beta_2 = square.material.beta_1;
    square.material.gamma_2 = square.material.gamma_1;
    CHECK(names(square).size() == 7);
}

TEST_CASE("symmetry: what holds or pulls the sheet breaks it") {
    ModelInput held = sheet(middle);
    held.supports = {{.vertex = 0}};
    CHECK(names(held).empty());
    ModelInput heavy = sheet(middle);
    heavy.gravity = {0, 0, -9810};
    CHECK(names(heavy).empty());
}

TEST_CASE("symmetry: a shape and its image store the same energy, to rounding") {
    for (const auto& print : {middle, all_over, halves}) {
        const Model model(sheet(print, MeshKind::jittered));
        const Eigen::VectorXd x = bent(model);
        const std::vector<SheetSymmetry> found = find_symmetries(model.input());
        CHECK(found.size() == 3);
        for (const SheetSymmetry& symmetry : found) {
            CAPTURE(symmetry.name);
            const ShapeImage mapped = image(symmetry, model.input(), x);
            ModelInput input = model.input();
            input.mesh = mapped.layout;
            input.print = mapped.print;
            const Model other(std::move(input));
            Eigen::VectorXd y = Eigen::VectorXd::Zero(other.size());
            y.head(mapped.x.size()) = mapped.x;
            CHECK(other.energy(y) == doctest::Approx(model.energy(x)).epsilon(1e-12));
        }
    }
}
