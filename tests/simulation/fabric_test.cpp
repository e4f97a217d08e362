// Bare fabric: release, clamped reactions, uniaxial tension, cantilever.
#include <doctest/doctest.h>

#include <Eigen/LU>
#include <cmath>

#include "reference_data.hpp"
#include "release.hpp"
#include "ruche/material/fabric_law.hpp"

using namespace ruche;
using namespace ruche::test;

namespace {

/// A column-value pair of each row that `keep` accepts.
std::vector<std::array<double, 2>> rows(const std::string& csv, int key, int value,
                                        const std::function<bool(const std::vector<double>&)>& keep) {
    std::vector<std::array<double, 2>> found;
    for (const std::vector<double>& row : read_csv(csv)) {
        if (keep(row)) found.push_back({row[key], row[value]});
    }
    return found;
}

}  // namespace

TEST_CASE("fabric: released alone it shrinks to the layout over the pre-stretch and stores nothing") {
    for (const std::array<double, 2> s : {std::array{1.7, 1.7}, std::array{1.5, 1.3}}) {
        const PrintMesh layout =
            printed(rectangle_mesh(MeshKind::jittered, {.length = 40, .width = 20, .across = 10}),
                    [](const Vec2&) { return 0.0; });
        ModelInput input;
        input.prestretch = s;
        input.mesh = layout.mesh;
        const Model model(input);
        const Equilibrium state = solve(model);
        REQUIRE(certain(state));
        CHECK(state.energy.total() < 1e-12 * model.energy(model.initial()));
        const std::vector<Vec3> shape = positions(state, layout);
        const auto corner = [&](double x, double y) {
            int best = 0;
            for (int v = 0; v < layout.mesh.vertex_count(); ++v) {
                if ((layout.mesh.vertices[v] - Vec2(x, y)).norm() <
                    (layout.mesh.vertices[best] - Vec2(x, y)).norm())
                    best = v;
            }
            return shape[best];
        };
        CHECK((corner(40, 0) - corner(0, 0)).norm() == doctest::Approx(40 / s[0]).epsilon(1e-6));
        CHECK((corner(0, 20) - corner(0, 0)).norm() == doctest::Approx(20 / s[1]).epsilon(1e-6));
    }
}

TEST_CASE("fabric: held on the frame it pulls with the law's equibiaxial stress") {
    // Reaction along x per width = h_f S11 s / s (nominal stress on relaxed width, width on the frame): h_f
    // S11.
    const PrintMesh layout =
        printed(rectangle_mesh(MeshKind::alternating, {.length = 20, .width = 10, .across = 5}),
                [](const Vec2&) { return 0.0; });
    ModelInput input;
    input.mesh = layout.mesh;
    const Model model(input);
    const Eigen::VectorXd gradient = model.gradient(model.initial());
    double pull = 0.0;
    for (int v = 0; v < layout.mesh.vertex_count(); ++v) {
        if (layout.mesh.vertices[v].x() > 20 - 1e-9) pull += gradient[3 * v];
    }
    CHECK(pull == doctest::Approx(0.46 * 0.1607727690 * 10).epsilon(1e-8));
}

TEST_CASE("fabric: a sheet under equal dead end forces follows the material point at every angle") {
    // Material point with free transverse and shear strain at lambda = 1.4, tests/data/reference (blend
    // 0.01).
    const auto reference = rows("uniaxial_orthotropic.csv", 1, 4, [](const std::vector<double>& row) {
        return row[0] == 1.0 && row[2] == 1.4;
    });
    REQUIRE(reference.size() == 7);
    for (const auto& [angle, nominal_stress_pa] : reference) {
        const double nominal_stress = 1e-6 * nominal_stress_pa;
        CAPTURE(angle);
        const double length = 60;
        const double width = 12;
        const PrintMesh layout =
            printed(rectangle_mesh(MeshKind::alternating, {.length = length, .width = width, .across = 6}),
                    [](const Vec2&) { return 0.0; });
        ModelInput input;
        input.prestretch = {1.0, 1.0};
        input.fabric_axis_deg = -angle;  // the pull is along x, at `angle` from e_1
        input.mesh = layout.mesh;
        // Tractions of a uniform nominal stress on both ends, by edge length.
        for (int v = 0; v < layout.mesh.vertex_count(); ++v) {
            const Vec2& p = layout.mesh.vertices[v];
            const bool left = p.x() < 1e-9;
            const bool right = p.x() > length - 1e-9;
            if (!left && !right) continue;
            const bool corner = p.y() < 1e-9 || p.y() > width - 1e-9;
            const double share = width / 6.0 * (corner ? 0.5 : 1.0);
            input.forces.push_back({v, Vec3((right ? 1.0 : -1.0) * nominal_stress * 0.46 * share, 0, 0)});
        }
        const Equilibrium state = solve(Model(input));
        INFO(state.message, " ", state.residual, " ", state.iterations);
        REQUIRE(certain(state));
        double left = 0.0;
        double right = 0.0;
        int count = 0;
        for (int v = 0; v < layout.mesh.vertex_count(); ++v) {
            const Vec2& p = layout.mesh.vertices[v];
            if (std::abs(p.x() - length / 3) < 1e-6) left += state.x[3 * v], ++count;
            if (std::abs(p.x() - 2 * length / 3) < 1e-6) right += state.x[3 * v];
        }
        CHECK((right - left) / count == doctest::Approx(1.4 * length / 3).epsilon(0.005));
    }
}

TEST_CASE(
    "fabric: a sample clamped at full width departs from the closed uniaxial law as its grips explain") {
    // 110 x 20 mm, as in the paper's tests, pulled to 1.4 times its length by grips that hold its width.
    const double length = 110;
    const double width = 20;
    const double stretch = 1.4;
    const auto reference = rows("uniaxial_orthotropic.csv", 1, 4, [=](const std::vector<double>& row) {
        return row[0] == 1.0 && row[2] == stretch;
    });
    REQUIRE(reference.size() == 7);
    const PrintMesh layout =
        printed(rectangle_mesh(MeshKind::alternating, {.length = length, .width = width, .across = 10}),
                [](const Vec2&) { return 0.0; });
    double largest = 0.0;
    for (const auto& [angle, nominal_stress_pa] : reference) {
        CAPTURE(angle);
        ModelInput input;
        input.prestretch = {1.0, 1.0};
        input.fabric_axis_deg = -angle;
        input.mesh = layout.mesh;
        for (int v = 0; v < layout.mesh.vertex_count(); ++v) {
            const Vec2& p = layout.mesh.vertices[v];
            if (p.x() < 1e-9) input.supports.push_back({v, {true, true, true}, Vec3(0, p.y(), 0)});
            if (p.x() > length - 1e-9)
                input.supports.push_back({v, {true, true, true}, Vec3(stretch * length, p.y(), 0)});
        }
        const Model model(input);
        const Equilibrium state = solve(model);
        REQUIRE(certain(state));
        const Eigen::VectorXd gradient = model.gradient(state.x);
        double force = 0.0;
        for (int v = 0; v < layout.mesh.vertex_count(); ++v) {
            if (layout.mesh.vertices[v].x() > length - 1e-9) force += gradient[3 * v];
        }
        const double free = 1e-6 * nominal_stress_pa;
        const double deviation = force / (input.material.fabric_thickness * width) / free - 1.0;
        MESSAGE("at ", angle, " deg the clamped sample pulls harder by ", 100.0 * deviation, " %");
        largest = std::max(largest, deviation);

        // Holding the width costs energy, so it pulls harder. How much at most: as if the grips suppressed
        // transverse strain and shear altogether within one width of each end (Saint-Venant) and the force
        // were the mean along the sample. In the fabric's axes the pull's direction is at `angle`.
        const double turn = angle * M_PI / 180.0;
        const Vec2 along(std::cos(turn), std::sin(turn));
        const double strain = 0.5 * (stretch * stretch - 1.0);
        const FabricResponse held = FabricLaw(input.material)(
            strain * Vec3(along.x() * along.x(), along.y() * along.y(), 2.0 * along.x() * along.y()));
        const double held_stress =
            stretch * (along.x() * along.x() * held.stress[0] + along.y() * along.y() * held.stress[1] +
                       2.0 * along.x() * along.y() * held.stress[2]);
        CHECK(deviation > 0.0);
        CHECK(deviation < 2.0 * width / length * (held_stress / free - 1.0));
    }
    // It is there, and it is what one would call about one per cent.
    CHECK(largest > 0.005);
    CHECK(largest < 0.02);
}

TEST_CASE("fabric: a cantilever under gravity follows the master curve") {
    // Right triangles whose diagonals alternate from column to column: there the hinge sum is a plate along
    // the grid. (Alternating like a chessboard it is 5/6 of one: vertices of valence 4 and 8 move against
    // each other.) Stretching is made stiff so that bending alone is tested. Gamma = areal weight L^3 / k_B.
    const int columns = 60;
    const int rows_across = 8;
    const double h = 1.0;
    // The hinge on the clamp's line bends for half an element on each side of it, so the beam begins h/2
    // before it.
    const double length = columns * h + 0.5 * h;
    TriangleMesh mesh;
    for (int j = 0; j <= rows_across; ++j) {
        for (int i = -1; i <= columns; ++i) mesh.vertices.emplace_back(i * h, j * h);
    }
    const int stride = columns + 2;
    for (int j = 0; j < rows_across; ++j) {
        for (int i = 0; i <= columns; ++i) {
            const int a = j * stride + i;
            const int b = a + 1;
            const int c = a + stride;
            const int d = c + 1;
            if (j % 2 == 0) {
                mesh.triangles.insert(mesh.triangles.end(), {{a, b, d}, {a, d, c}});
            } else {
                mesh.triangles.insert(mesh.triangles.end(), {{a, b, c}, {b, d, c}});
            }
        }
    }
    const auto reference = rows("cantilever_master_curve.csv", 0, 3, [](const std::vector<double>& row) {
        return row[0] == 1 || row[0] == 5 || row[0] == 10 || row[0] == 20 || row[0] == 50;
    });
    REQUIRE(reference.size() == 5);
    for (const auto& [gamma, y_over_x] : reference) {
        CAPTURE(gamma);
        ModelInput input;
        input.prestretch = {1.0, 1.0};
        input.mesh = mesh;
        Material& m = input.material;
        m.alpha_1 = m.alpha_2 = m.alpha_3 = 10.0;
        m.fabric_poissons_ratio = 0.0;
        const double weight = gamma * m.fabric_bending_stiffness / std::pow(length, 3);  // N/mm^2
        input.gravity = {0, 0, -weight / (m.fabric_areal_density * 1e-9)};
        for (int v = 0; v < mesh.vertex_count(); ++v) {
            const Vec2& p = mesh.vertices[v];
            if (p.x() < 1e-9) input.supports.push_back({v, {true, true, true}, Vec3(p.x(), p.y(), 0)});
        }
        const Equilibrium state = solve(Model(input));
        REQUIRE(certain(state));
        double x = 0.0;
        double y = 0.0;
        for (int j = 0; j <= rows_across; ++j) {
            const int tip = j * stride + stride - 1;
            x += state.x[3 * tip] + 0.5 * h;
            y -= state.x[3 * tip + 2];
        }
        CHECK(y / x == doctest::Approx(y_over_x).epsilon(0.01));
    }
}
