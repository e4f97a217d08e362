#include "ruche/statics/transfer.hpp"

#include <doctest/doctest.h>

#include <cmath>
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
