#include "ruche/study/sensitivity/sensitivity.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "energy/samples.hpp"
#include "ruche/material/fabric_law_parameters.hpp"
#include "ruche/meshing/structured.hpp"
#include "ruche/study/sensitivity/model_parameters.hpp"

using namespace ruche;
using namespace ruche::test;

namespace {

const ModelParameter& parameter_named(const std::vector<ModelParameter>& parameters,
                                      const std::string& name) {
    const auto at = std::ranges::find(parameters, name, &ModelParameter::name);
    REQUIRE(at != parameters.end());
    return *at;
}

/// A bare triangle, stretched so that its Green strain E11 is `margin` below gamma_1.
struct StretchedTriangle {
    Model model;
    Eigen::VectorXd x;
    Mat2 deformation;

    explicit StretchedTriangle(double margin)
        : model({.mesh = {.vertices = {{0, 0}, {2, 0.3}, {0.4, 1.5}}, .triangles = {{0, 1, 2}}},
                 .prestretch = {1.6, 1.5}}) {
        const double stretch = std::sqrt(1.0 + 2.0 * (Material{}.gamma_1 - margin));
        deformation << stretch, 0.2, 0.0, 1.3;
        x = Eigen::VectorXd::Zero(9);
        for (int v = 0; v < 3; ++v) {
            const Vec2& p = model.input().mesh.vertices[static_cast<std::size_t>(v)];
            x.segment<2>(3 * v) = deformation * Vec2(p.x() / 1.6, p.y() / 1.5);
        }
    }
};

/// p d(grad W)/dp of such a triangle from the derivative of its stress.
Eigen::VectorXd exact_change(const StretchedTriangle& triangle, std::size_t parameter) {
    const ModelInput& input = triangle.model.input();
    const Mat2 green = 0.5 * (triangle.deformation.transpose() * triangle.deformation - Mat2::Identity());
    const StressByParameter by_parameter =
        stress_by_parameter(input.material, {.log_extension = input.options.log_extension},
                            {green(0, 0), green(1, 1), 2.0 * green(0, 1)});
    const Vec3 s =
        by_parameter.col(static_cast<int>(parameter)) * input.material.*law_parameters.at(parameter);
    Mat2 stress;
    stress << s[0], s[2], s[2], s[1];
    Mat2 edges;  // relaxed
    for (int i = 0; i < 2; ++i) {
        const Vec2 edge = input.mesh.vertices[static_cast<std::size_t>(i) + 1] - input.mesh.vertices[0];
        edges.col(i) = Vec2(edge.x() / 1.6, edge.y() / 1.5);
    }
    const double volume = 0.5 * edges.determinant() * input.material.fabric_thickness;
    const Mat2 forces = volume * triangle.deformation * stress * edges.transpose().inverse();
    Eigen::VectorXd change = Eigen::VectorXd::Zero(9);
    change.segment<2>(3) = forces.col(0);
    change.segment<2>(6) = forces.col(1);
    change.segment<2>(0) = -forces.col(0) - forces.col(1);
    return change;
}

}  // namespace

TEST_CASE("gradient by parameter: it is that of the fabric's law, close to the law's end too") {
    const char* names[] = {"alpha_1_mpa", "alpha_2_mpa", "alpha_3_mpa", "beta_1_mpa",
                           "beta_2_mpa",  "gamma_1",     "gamma_2",     "fabric_poissons_ratio"};
    for (const double margin : {0.3, 0.018, 0.0011, 0.0009, -0.01}) {
        const StretchedTriangle triangle(margin);
        const std::vector<ModelParameter> parameters = model_parameters(triangle.model.input());
        for (std::size_t p = 0; p < law_parameter_count; ++p) {
            CAPTURE(margin);
            CAPTURE(std::string(names[p]));
            const GradientChange change = gradient_change(
                triangle.model, triangle.x, parameter_named(parameters, std::string("material.") + names[p]));
            const Eigen::VectorXd exact = exact_change(triangle, p);
            CHECK((change.gradient - exact).cwiseAbs().maxCoeff() < 1e-8 * exact.cwiseAbs().maxCoeff());
            CHECK(change.error < 1e-7 * exact.cwiseAbs().maxCoeff());
        }
    }
}

TEST_CASE("gradient by parameter: energies of a parameter's first power change by themselves") {
    for (const SetUp& set_up : set_ups()) {
        CAPTURE(std::string(set_up.name));
        const Model model(set_up.input);
        const Eigen::VectorXd x = rolled(model, {});
        const std::vector<ModelParameter> parameters = model_parameters(model.input());
        ModelInput limp = model.input();
        limp.material.fabric_bending_stiffness = 0.0;
        const Eigen::VectorXd exact = model.gradient(x) - Model(limp).gradient(x);
        const GradientChange change =
            gradient_change(model, x, parameter_named(parameters, "material.fabric_bending_stiffness_n_mm"));
        CHECK((change.gradient - exact).cwiseAbs().maxCoeff() <
              1e-10 * model.gradient(x).cwiseAbs().maxCoeff());
    }
}

TEST_CASE("gradient by parameter: all moduli and forces doubled are all forces doubled") {
    for (const SetUp& set_up : set_ups()) {
        CAPTURE(std::string(set_up.name));
        ModelInput input = set_up.input;
        input.gravity = {0, 0, 0};
        input.table.present = false;
        input.forces.clear();
        const Model model(input);
        const Eigen::VectorXd x = rolled(model, {});
        Eigen::VectorXd sum = Eigen::VectorXd::Zero(x.size());
        for (const ModelParameter& parameter : model_parameters(input)) {
            if (parameter.unit != "MPa" && parameter.unit != "N mm") continue;
            sum += gradient_change(model, x, parameter).gradient;
        }
        const Eigen::VectorXd all = model.gradient(x);
        CHECK((sum - all).cwiseAbs().maxCoeff() < 1e-8 * all.cwiseAbs().maxCoeff());
    }
}

TEST_CASE("shape measures: their rates are derivatives, and no rigid motion changes them") {
    PrintMesh layout;
    layout.mesh = rectangle_mesh(MeshKind::jittered, {.length = 20.0, .width = 6.0, .across = 4});
    layout.print.resize(layout.mesh.triangles.size());
    layout.strips.push_back(
        {.id = "a", .centreline = {points_on_mesh(layout.mesh, {{1.0, 1.5}, {19.0, 1.5}}, 61)}});
    layout.strips.push_back(
        {.id = "b", .centreline = {points_on_mesh(layout.mesh, {{1.0, 5.2}, {11.0, 5.2}}, 61)}});
    std::mt19937 random(5);
    std::normal_distribution<double> normal;
    std::vector<Vec3> rest;
    std::vector<Vec3> velocities;
    std::vector<Vec3> rigid;
    const Vec3 spin(0.3, -0.7, 0.2);
    for (const Vec2& p : layout.mesh.vertices) {
        // Bent the other way on one side, so that the two strips' curvatures differ in sign.
        rest.emplace_back(p.x(), p.y(), 0.06 * (p.x() - 10) * (p.x() - 10) * (p.y() > 3.7 ? -1 : 1));
        velocities.emplace_back(normal(random), normal(random), normal(random));
        rigid.emplace_back(spin.cross(rest.back()) + Vec3(1, 2, 3));
    }
    const auto moved = [&](double t) {
        std::vector<Vec3> shape = rest;
        for (std::size_t v = 0; v < shape.size(); ++v) shape[v] += t * velocities[v];
        std::vector<double> values;
        const ShapeMeasures there(layout, shape);
        for (const ShapeMeasure& measure : there.values()) values.push_back(measure.value);
        return values;
    };
    const ShapeMeasures measures(layout, rest);
    const std::vector<double> rates = measures.rates(velocities);
    const std::vector<double> still = measures.rates(rigid);
    REQUIRE(rates.size() == 8);
    REQUIRE(measures.values().size() == 8);
    CHECK(measures.values()[7].name == "curvature.b");
    CHECK(measures.values()[6].value * measures.values()[7].value < 0.0);
    const double h = 1e-4;
    const auto wide = std::array{moved(h), moved(-h)};
    const auto narrow = std::array{moved(0.5 * h), moved(-0.5 * h)};
    for (std::size_t m = 0; m < rates.size(); ++m) {
        CAPTURE(measures.values()[m].name);
        const double coarse = (wide[0][m] - wide[1][m]) / (2 * h);
        const double fine = (narrow[0][m] - narrow[1][m]) / h;
        CHECK(rates[m] == doctest::Approx((4 * fine - coarse) / 3).epsilon(1e-7));
        CHECK(std::abs(still[m]) < 1e-10 * std::max(1.0, measures.values()[m].value));
    }
}
