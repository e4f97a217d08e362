#include "ruche/energy/model.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "energy/battery.hpp"
#include "energy/samples.hpp"
#include "reference_data.hpp"
#include "ruche/core/error.hpp"

using namespace ruche;
using namespace ruche::test;

namespace {

/// The unit square of two triangles with the diagonal 0-2, all bare.
ModelInput square() {
    ModelInput input;
    input.mesh.vertices = {Vec2(0.0, 0.0), Vec2(1.0, 0.0), Vec2(1.0, 1.0), Vec2(0.0, 1.0)};
    input.mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    return input;
}

/// The square folded at its diagonal: the triangle of vertex 3 rises by theta.
Eigen::VectorXd folded(const Model& model, double theta) {
    Eigen::VectorXd x = model.initial();
    const double r = std::sqrt(0.5);
    const Vec3 outward(-r, r, 0.0);
    x.segment<3>(9) = Vec3(0.5, 0.5, 0.0) + r * (std::cos(theta) * outward + std::sin(theta) * Vec3::UnitZ());
    return x;
}

}  // namespace

TEST_CASE("model: a hinge on the unit square has the energy of the reference in both normalisations") {
    ModelInput input = square();
    Material& m = input.material;
    m.alpha_1 = m.alpha_2 = m.alpha_3 = m.beta_1 = m.beta_2 = m.neo_hookean_share = 0.0;
    const Model plate(input);
    input.options.bending_normalisation = BendingNormalisation::as_printed;
    const Model as_printed(input);
    const auto rows = read_csv("unit_hinge.csv");
    REQUIRE(rows.size() == 6);
    for (const std::vector<double>& row : rows) {
        CAPTURE(row[0]);
        constexpr double joule = 1e3;  // in mJ; twelve digits are printed
        CHECK(as_printed.energy(folded(as_printed, row[0])) ==
              doctest::Approx(joule * row[2]).epsilon(1e-11));
        CHECK(plate.energy(folded(plate, row[0])) == doctest::Approx(joule * row[3]).epsilon(1e-11));
    }
}

TEST_CASE("model: edge unknowns follow the positions, one per edge between printed triangles in edge order") {
    const Model model(patchwork());
    const auto& print = model.input().print;
    const Eigen::VectorXd x = rolled(model, {});
    const std::vector<double> before = model.energy_density(x);
    int at = 3 * model.vertex_count();
    for (const Edge& edge : model.edges().edges) {
        if (edge.on_boundary() || print[edge.triangle[0]].bare() || print[edge.triangle[1]].bare()) continue;
        REQUIRE(at < model.size());
        const auto around = model.vertices_of_edge_unknown(at - 3 * model.vertex_count());
        CHECK(around[0] == edge.vertex[0]);
        CHECK(around[1] == edge.vertex[1]);
        CHECK(around[2] == model.input().mesh.triangles[edge.triangle[0]][edge.local[0]]);
        CHECK(around[3] == model.input().mesh.triangles[edge.triangle[1]][edge.local[1]]);
        Eigen::VectorXd moved = x;
        moved[at++] += 0.05;
        const std::vector<double> after = model.energy_density(moved);
        for (int t = 0; t < int(after.size()); ++t) {
            const bool beside = t == edge.triangle[0] || t == edge.triangle[1];
            CHECK((after[t] != before[t]) == beside);
        }
    }
    CHECK(at == model.size());
}

TEST_CASE("model: with the fabric's own law under plastic every rim has an unknown of its own triangle") {
    ModelInput input = patchwork();
    input.options.fabric_ply = FabricPlyLaw::same_law;
    const Model model(input);
    const auto& print = model.input().print;
    const Eigen::VectorXd x = rolled(model, {});
    const std::vector<double> before = model.energy_density(x);
    int at = 3 * model.vertex_count();
    int rims = 0;
    for (const Edge& edge : model.edges().edges) {
        const bool printed0 = !print[edge.triangle[0]].bare();
        const bool printed1 = !edge.on_boundary() && !print[edge.triangle[1]].bare();
        if (!printed0 && !printed1) continue;
        const bool rim = !(printed0 && printed1);
        rims += rim ? 1 : 0;
        REQUIRE(at < model.size());
        const auto around = model.vertices_of_edge_unknown(at - 3 * model.vertex_count());
        CHECK(around[0] == edge.vertex[0]);
        CHECK(around[1] == edge.vertex[1]);
        CHECK((around[2] == around[3]) == rim);
        Eigen::VectorXd moved = x;
        moved[at++] += 0.05;
        const std::vector<double> after = model.energy_density(moved);
        for (int t = 0; t < int(after.size()); ++t) {
            const bool beside = t == edge.triangle[0] || t == edge.triangle[1];
            CHECK((after[t] != before[t]) == (beside && !print[t].bare()));
        }
    }
    CHECK(at == model.size());
    CHECK(rims > 10);
    input.options.edge_normals = EdgeNormals::averaged;
    CHECK(Model(input).size() == 3 * model.vertex_count());
}

TEST_CASE("model: a positive edge unknown bends the edge's first triangle more and its second one less") {
    ModelInput input = square();
    input.print.assign(2, {.front = 0.6});
    input.prestretch = {1.0, 1.0};
    input.material.fabric_youngs_modulus = 0.0;
    const Model model(std::move(input));
    REQUIRE(model.size() == 13);
    Eigen::VectorXd x = folded(model, 0.3);
    const std::vector<double> before = model.energy_density(x);
    x[12] = -0.02;
    const std::vector<double> less = model.energy_density(x);
    x[12] = 0.02;
    const std::vector<double> more = model.energy_density(x);
    CHECK(less[0] != doctest::Approx(before[0]));
    CHECK((more[0] - before[0]) * (more[1] - before[1]) < 0.0);
    CHECK((more[0] - before[0]) * (less[0] - before[0]) < 0.0);
    // The same by symmetry with the two triangles exchanged.
    CHECK(more[0] == doctest::Approx(less[1]).epsilon(1e-12));
}

TEST_CASE("model: whole turns of normals about edges change no energy and are taken out") {
    const Model model(patchwork());
    const Eigen::VectorXd x = rolled(model, {});
    const TriangleMesh& mesh = model.input().mesh;
    const int positions = 3 * model.vertex_count();
    Eigen::VectorXd wound = x;
    int edges = 0;
    for (const Edge& edge : model.edges().edges) {
        const auto printed = [&](int side) { return !model.input().print[edge.triangle[side]].bare(); };
        if (edge.on_boundary() || !printed(0) || !printed(1)) continue;
        const double length = (mesh.vertices[edge.vertex[1]] - mesh.vertices[edge.vertex[0]]).norm();
        const double area = layout_area(mesh, edge.triangle[0]) + layout_area(mesh, edge.triangle[1]);
        const double turns = edges % 2 == 0 ? edges + 1 : -(edges + 1);
        wound[positions + edges] += turns * 2.0 * std::numbers::pi * area / length;
        ++edges;
    }
    REQUIRE(edges == model.size() - positions);
    REQUIRE(edges > 2);
    CHECK(model.energy(wound) == doctest::Approx(model.energy(x)).epsilon(1e-12));
    CHECK(model.health(wound).max_edge_rotation_deg > 180.0);
    model.unwind(wound);
    CHECK((wound - x).cwiseAbs().maxCoeff() < 1e-12);
    Eigen::VectorXd same = x;
    model.unwind(same);
    CHECK(same == x);
}

TEST_CASE("model: averaged edge normals and bare fabric have no edge unknowns") {
    ModelInput input = patchwork();
    input.options.edge_normals = EdgeNormals::averaged;
    CHECK(Model(input).size() == 3 * input.mesh.vertex_count());
    input.options.edge_normals = EdgeNormals::free;
    input.print.clear();
    CHECK(Model(input).size() == 3 * input.mesh.vertex_count());
}

TEST_CASE("model: the Hessian is full and symmetric, and its pattern does not depend on the state") {
    const Model model(patchwork());
    const Eigen::SparseMatrix<double> h = model.hessian(rolled(model, {}));
    CHECK(h.isCompressed());
    CHECK(h.rows() == model.size());
    CHECK(h.toDense() == h.toDense().transpose());
    const Eigen::SparseMatrix<double> flat = model.hessian(model.initial());
    CHECK(flat.nonZeros() == h.nonZeros());
    for (int c = 0; c < h.outerSize(); ++c) {
        for (int k = h.outerIndexPtr()[c] + 1; k < h.outerIndexPtr()[c + 1]; ++k) {
            CHECK(h.innerIndexPtr()[k - 1] < h.innerIndexPtr()[k]);
        }
    }
    const Eigen::VectorXd x = rolled(model, {});
    AssembledSums sums;
    CHECK(model.evaluate(x, Order::gradient, sums).total() == model.energy(x));
    CHECK(sums.gradient == model.gradient(x));
}

TEST_CASE("model: initial is the flat layout with edge unknowns zero") {
    const Model model(patchwork());
    const Eigen::VectorXd x = model.initial();
    for (int v = 0; v < model.vertex_count(); ++v) {
        CHECK(x.segment<2>(3 * v) == model.input().mesh.vertices[v]);
        CHECK(x[3 * v + 2] == 0.0);
    }
    CHECK(x.tail(model.size() - 3 * model.vertex_count()).isZero(0.0));
}

TEST_CASE("model: weight is areal density of the relaxed fabric and the plastic's volume, in newtons") {
    ModelInput input;
    input.mesh.vertices = {Vec2(0.0, 0.0), Vec2(30.0, 0.0), Vec2(0.0, 20.0)};
    input.mesh.triangles = {{0, 1, 2}};
    input.prestretch = {1.5, 1.2};
    input.gravity = {0.0, 0.0, -9810.0};
    input.material.fabric_areal_density = 0.36;
    input.material.plastic_density = 1000.0;
    // 300 mm^2 of layout are 300 / 1.8 mm^2 relaxed: 0.36 kg/m^2 of that are 60e-6 kg; 0.5 mm of plastic on
    // 300 mm^2 are 150e-6 kg.
    for (const auto& [print, kilograms] : {std::pair{Print{}, 60e-6},
                                           {Print{.front = 0.5}, 210e-6},
                                           {Print{.front = 0.2, .back = 0.3}, 210e-6}}) {
        input.print = {print};
        const Model model(input);
        ModelInput weightless = input;
        weightless.gravity = {0.0, 0.0, 0.0};
        Eigen::VectorXd x = model.initial();
        for (int v = 0; v < 3; ++v) x[3 * v + 2] = 7.0;
        const double newtons = kilograms * 9.81;
        CHECK(model.energy_terms(x).gravity == doctest::Approx(newtons * 7.0).epsilon(1e-12));  // mJ = N mm
        const Eigen::VectorXd weight = model.gradient(x) - Model(weightless).gradient(x);
        for (int v = 0; v < 3; ++v) CHECK(weight[3 * v + 2] == doctest::Approx(newtons / 3.0).epsilon(1e-9));
    }
}

TEST_CASE("model: as-printed laminate thickness is the laminate with every layer halved") {
    for (const EdgeNormals normals : {EdgeNormals::free, EdgeNormals::averaged}) {
        ModelInput input = patchwork();
        input.options.edge_normals = normals;
        input.options.laminate_thickness = LaminateThickness::as_printed;
        const Model as_printed(input);
        input.options.laminate_thickness = LaminateThickness::true_thickness;
        input.material.fabric_thickness *= 0.5;
        for (Print& print : input.print) print.front *= 0.5;
        const Model halved(input);
        const Eigen::VectorXd x = rolled(halved, {});
        CHECK(as_printed.energy_terms(x).plastic ==
              doctest::Approx(halved.energy_terms(x).plastic).epsilon(1e-13));
        // The bare fabric keeps its thickness.
        CHECK(as_printed.energy_terms(x).fabric_membrane ==
              doctest::Approx(2.0 * halved.energy_terms(x).fabric_membrane).epsilon(1e-13));
    }
}

TEST_CASE("model: tensor shear is half of alpha_3") {
    ModelInput input = patchwork();
    input.options.shear_strain = ShearStrain::tensor;
    const Model tensor(input);
    input.options.shear_strain = ShearStrain::engineering;
    input.material.alpha_3 *= 0.5;
    const Model half(input);
    const Eigen::VectorXd x = rolled(half, {});
    CHECK(tensor.energy(x) == doctest::Approx(half.energy(x)).epsilon(1e-13));
    CHECK(tensor.energy(x) != doctest::Approx(Model(patchwork()).energy(x)).epsilon(1e-6));
}

TEST_CASE("model: energy density times layout area sums to membrane and laminate energy") {
    for (const SetUp& set_up : set_ups()) {
        CAPTURE(set_up.name);
        const Model model(set_up.input);
        const Eigen::VectorXd x = rolled(model, {.turned = set_up.turns_freely});
        const std::vector<double> density = model.energy_density(x);
        double membrane = 0.0;
        double laminate = 0.0;
        for (int t = 0; t < int(density.size()); ++t) {
            const double energy = density[t] * layout_area(model.input().mesh, t);
            (model.input().print[t].bare() ? membrane : laminate) += energy;
        }
        const EnergyTerms terms = model.energy_terms(x);
        CHECK(membrane == doctest::Approx(terms.fabric_membrane).epsilon(1e-12));
        // Rods have no area.
        CHECK(laminate == doctest::Approx(set_up.input.rods.empty() ? terms.plastic : 0.0).epsilon(1e-12));
    }
}

TEST_CASE("model: health tells what the state is") {
    ModelInput input = square();
    input.prestretch = {1.7, 1.7};
    const Model bare(input);
    const Health held = bare.health(folded(bare, 0.5));
    CHECK(held.max_strain_margin == doctest::Approx(0.945 - 0.9626).epsilon(1e-12));
    CHECK(held.beyond_law == 0);
    CHECK(held.min_area_ratio == 1.0);  // nothing is smaller than at rest
    CHECK(held.max_dihedral_deg == doctest::Approx(0.5 * 180.0 / 3.14159265358979).epsilon(1e-12));
    CHECK(bare.health(1.02 * bare.initial()).beyond_law == 2);
    CHECK(bare.health(0.3 * bare.initial()).min_area_ratio == doctest::Approx(0.09 * 2.89).epsilon(1e-12));
    input.print.assign(2, {.front = 0.6});
    const Model printed(input);
    Eigen::VectorXd x = folded(printed, 0.5);
    x[12] = 0.1;  // mean altitude of the diagonal: sqrt(1/2)
    CHECK(printed.health(x).max_edge_rotation_deg ==
          doctest::Approx((0.25 + 0.1 / std::sqrt(0.5)) * 180.0 / 3.14159265358979).epsilon(1e-12));
    CHECK(printed.health(0.5 * printed.initial()).min_area_ratio == doctest::Approx(0.25).epsilon(1e-12));
}

TEST_CASE("model: an input without meaning is an error that names what is wrong") {
    const double nan = std::nan("");
    const std::pair<const char*, std::function<void(ModelInput&)>> cases[] = {
        {"mesh", [](ModelInput& i) { i.mesh.triangles.clear(); }},
        {"mesh", [&](ModelInput& i) { i.mesh.vertices[1].x() = nan; }},
        {"mesh triangle 1", [](ModelInput& i) { i.mesh.triangles[1][2] = 9; }},
        {"mesh triangle 1", [](ModelInput& i) { std::swap(i.mesh.triangles[1][0], i.mesh.triangles[1][1]); }},
        {"mesh triangle 0", [](ModelInput& i) { i.mesh.vertices[1] = Vec2(0.5, 0.5); }},
        {"print", [](ModelInput& i) { i.print.resize(5); }},
        {"mesh triangle 0", [](ModelInput& i) { i.print.assign(2, {.front = -0.1}); }},
        {"mesh triangle 0", [&](ModelInput& i) { i.print.assign(2, {.back_modulus = nan}); }},
        {"material.gamma_1", [&](ModelInput& i) { i.material.gamma_1 = nan; }},
        {"material.fabric_poissons_ratio", [](ModelInput& i) { i.material.fabric_poissons_ratio = 1.0; }},
        {"material.neo_hookean_share", [](ModelInput& i) { i.material.neo_hookean_share = 1.5; }},
        {"model.log_extension", [](ModelInput& i) { i.options.log_extension = 0.0; }},
        {"model.log_extension",
         [](ModelInput& i) {
             i.material.gamma_2 = 0.01;
             i.options.log_extension = 0.02;
         }},
        {"prestretch", [](ModelInput& i) { i.prestretch[1] = 0.0; }},
        {"prestretch", [&](ModelInput& i) { i.prestretch[0] = nan; }},
        {"model", [&](ModelInput& i) { i.gravity[2] = nan; }},
        {"model", [&](ModelInput& i) { i.fabric_axis_deg = infinity; }},
        {"support", [](ModelInput& i) { i.supports = {{.vertex = 4}}; }},
        {"force", [](ModelInput& i) { i.forces = {{.vertex = -1}}; }},
        {"force", [&](ModelInput& i) { i.forces = {{.vertex = 1, .force = Vec3(nan, 0, 0)}}; }},
    };
    for (const auto& [key, spoil] : cases) {
        ModelInput input = square();
        spoil(input);
        CAPTURE(key);
        try {
            const Model model(std::move(input));
            FAIL_CHECK("accepted");
        } catch (const InputError& error) {
            CHECK(error.place().key.starts_with(key));
        }
    }
}

TEST_CASE("model: hopeless states are not finite or large, at every order, and never a crash") {
    const Model model(patchwork());
    const double start = model.energy(model.initial());
    const Eigen::VectorXd states[] = {
        Eigen::VectorXd::Zero(model.size()), Eigen::VectorXd::Constant(model.size(), std::nan("")),
        Eigen::VectorXd::Constant(model.size(), infinity), 1e200 * model.initial()};
    for (const Eigen::VectorXd& x : states) {
        AssembledSums sums;
        for (const Order order : {Order::value, Order::gradient, Order::hessian, Order::gauss_newton}) {
            CHECK_FALSE(model.evaluate(x, order, sums).total() < start);
        }
        model.health(x);
        model.energy_density(x);
    }
}

TEST_CASE("model: the pattern multiplies the Hessian by a vector as its full matrix does") {
    for (const SetUp& set_up : set_ups()) {
        CAPTURE(set_up.name);
        const Model model(set_up.input);
        AssembledSums sums;
        model.evaluate(rolled(model, {}), Order::hessian, sums);
        const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(model.size(), -1.0, 2.0);
        const Eigen::VectorXd expected = model.pattern().full_matrix(sums.hessian) * x;
        const Eigen::VectorXd product = model.pattern().product(sums.hessian, x);
        CHECK((product - expected).cwiseAbs().maxCoeff() < 1e-13 * expected.cwiseAbs().maxCoeff());
    }
}

TEST_CASE("model: a patch has the derivatives of the whole sheet and the differences of its energy") {
    for (const SetUp& set_up : set_ups()) {
        CAPTURE(set_up.name);
        const Model model(set_up.input);
        Eigen::VectorXd x = rolled(model, {});
        std::vector<char> held(model.size(), 0);
        held[3 * 3 + 2] = 1;
        std::vector<int> nodes = {3, 0, 2};  // the smallest of the sheets has four vertices
        if (model.pattern().node_count() > model.vertex_count()) nodes.push_back(model.vertex_count());
        const Model::Patch patch = model.patch(nodes, held);
        REQUIRE(patch.size() == static_cast<int>(8 + (nodes.size() - 3)));
        for (const Order order : {Order::gradient, Order::hessian, Order::gauss_newton}) {
            DenseSums part;
            AssembledSums whole;
            model.evaluate(patch, x, order, part);
            model.evaluate(x, order, whole);
            const double force = whole.gradient.cwiseAbs().maxCoeff();
            for (int i = 0; i < patch.size(); ++i)
                CHECK(std::abs(part.gradient[i] - whole.gradient[patch.unknowns()[i]]) < 1e-13 * force);
            if (!order.wants_hessian()) continue;
            const Eigen::SparseMatrix<double> full = model.pattern().full_matrix(whole.hessian);
            const double stiffness = part.hessian.cwiseAbs().maxCoeff();
            for (int i = 0; i < patch.size(); ++i) {
                for (int j = 0; j < patch.size(); ++j) {
                    const double expected = full.coeff(patch.unknowns()[i], patch.unknowns()[j]);
                    CHECK(std::abs(part.hessian(i, j) - expected) < 1e-13 * stiffness);
                }
            }
        }
        DenseSums none;
        const double part_before = model.evaluate(patch, x, Order::value, none);
        const double whole_before = model.energy(x);
        for (int i = 0; i < patch.size(); ++i) x[patch.unknowns()[i]] += 0.01 * std::cos(i);
        const double change = model.energy(x) - whole_before;
        CHECK(change != 0.0);
        CHECK(model.evaluate(patch, x, Order::value, none) - part_before ==
              doctest::Approx(change).epsilon(1e-9));
    }
}
