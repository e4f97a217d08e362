#include "ruche/statics/transfer.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "ruche/meshing/structured.hpp"

using namespace ruche;

namespace {

constexpr double radius = 5.0;

/// A sheet of 30 x 6 mm in cells of the given size, its middle third printed.
Model sheet(double cell) {
    ModelInput input;
    input.mesh =
        rectangle_mesh(MeshKind::jittered, {.length = 30, .width = 6, .across = int(std::lround(6 / cell))});
    for (const Triangle& tri : input.mesh.triangles) {
        const double y = (input.mesh.vertices[tri[0]].y() + input.mesh.vertices[tri[1]].y() +
                          input.mesh.vertices[tri[2]].y()) /
                         3.0;
        input.print.push_back({.front = y > 2 && y < 4 ? 0.6 : 0.0});
    }
    return Model(std::move(input));
}

/// Rolled by six radians, and contracted to 90 % along and 80 % across.
Eigen::VectorXd rolled(const Model& model) {
    Eigen::VectorXd x = model.initial();
    for (int v = 0; v < model.vertex_count(); ++v) {
        const double angle = 0.9 * x[3 * v] / radius;
        x.segment<3>(3 * v) = Vec3(radius * std::sin(angle), 0.8 * x[3 * v + 1], radius * std::cos(angle));
    }
    return x;
}

/// Flat, to one length along and another across.
Eigen::VectorXd stretched(const Model& model, double along, double across) {
    Eigen::VectorXd x = model.initial();
    for (int v = 0; v < model.vertex_count(); ++v) {
        x[3 * v] *= along;
        x[3 * v + 1] *= across;
    }
    return x;
}

double length_of(const Model& model, const Eigen::VectorXd& x, int component) {
    const Eigen::Map<const Eigen::Matrix3Xd> positions(x.data(), 3, model.vertex_count());
    return positions.row(component).maxCoeff() - positions.row(component).minCoeff();
}

/// Largest distance from the exact roll on the finer mesh, without the mean displacement (it is free).
double error_from(double coarse_cell) {
    const Model coarse = sheet(coarse_cell);
    const Model fine = sheet(0.5);
    Retraction retraction(fine);
    const Eigen::VectorXd on_coarse = rolled(coarse);
    const Eigen::VectorXd x = transfer(
        {.layout = coarse.input().mesh, .print = coarse.input().print, .x = on_coarse}, fine, retraction);
    CHECK(x.tail(x.size() - 3 * fine.vertex_count()).norm() == 0.0);
    const Eigen::VectorXd exact = rolled(fine);
    Vec3 mean = Vec3::Zero();
    for (int v = 0; v < fine.vertex_count(); ++v) mean += (x - exact).segment<3>(3 * v) / fine.vertex_count();
    double largest = 0.0;
    for (int v = 0; v < fine.vertex_count(); ++v)
        largest = std::max(largest, ((x - exact).segment<3>(3 * v) - mean).norm());
    return largest;
}

}  // namespace

TEST_CASE("transfer: a roll of several radians stays a roll, the better the finer the mesh it comes from") {
    const double from_2mm = error_from(2.0);
    const double from_1mm = error_from(1.0);
    // Facets of 2 mm on a radius of 5 mm: the chord misses the arc by s^2 / (8 r) = 0.1 mm, and their length
    // adds up to a shorter sheet by (s / r)^2 / 24 = 0.7 % of 27 mm.
    CHECK(from_2mm < 0.3);
    CHECK(from_1mm < 0.5 * from_2mm);
}

TEST_CASE("transfer: fabric that is squeezed far is opened, other fabric and plastic are not") {
    const double shortest = 0.85 / 1.6;
    const auto printed_all_over = [](double cell, const Print& print) {
        ModelInput input = sheet(cell).input();
        input.print.assign(input.print.size(), print);
        input.prestretch = {1.25, 1.6};
        return Model(std::move(input));
    };
    const auto lengths = [&](const Print& print, double along, double across) {
        const Model coarse = printed_all_over(1.0, print);
        const Model fine = printed_all_over(0.5, print);
        const Eigen::VectorXd from = stretched(coarse, along, across);
        Retraction retraction(fine);
        const Eigen::VectorXd x = transfer(
            {.layout = coarse.input().mesh, .print = coarse.input().print, .x = from}, fine, retraction);
        return std::array{length_of(fine, x, 0) / 30.0, length_of(fine, x, 1) / 6.0};
    };
    const Print bare;
    const Print plastic = {.front = 0.6};
    const std::array squeezed = lengths(bare, 0.9, 0.01);
    CHECK(squeezed[0] == doctest::Approx(0.9));
    CHECK(squeezed[1] == doctest::Approx(shortest));
    const std::array at_rest = lengths(bare, 1.0 / 1.25, 1.0 / 1.6);
    CHECK(at_rest[0] == doctest::Approx(1.0 / 1.25));
    CHECK(at_rest[1] == doctest::Approx(1.0 / 1.6));
    const std::array hard = lengths(plastic, 1.0, 0.4);
    CHECK(hard[0] == doctest::Approx(1.0));
    CHECK(hard[1] == doctest::Approx(0.4));
}
