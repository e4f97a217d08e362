#include "ruche/study/cantilever_sample.hpp"

#include <algorithm>
#include <cmath>

#include "ruche/core/error.hpp"
#include "ruche/statics/equilibrium.hpp"

namespace ruche {
namespace {

/// Right triangles whose diagonals change direction from row to row: there the sum over hinges is a plate
/// along the strip (see the theory page), which it is on hardly any other mesh. The column before x = 0 is in
/// the clamp.
struct Grid {
    int columns, rows;
    double length, width;  // of an element

    int stride() const { return columns + 2; }
    int vertex(int i, int j) const { return j * stride() + i + 1; }  // i = -1 ... columns

    TriangleMesh mesh() const {
        TriangleMesh mesh;
        for (int j = 0; j <= rows; ++j)
            for (int i = -1; i <= columns; ++i) mesh.vertices.emplace_back(i * length, j * width);
        for (int j = 0; j < rows; ++j) {
            for (int i = -1; i < columns; ++i) {
                const int a = vertex(i, j);
                const int b = vertex(i + 1, j);
                const int c = vertex(i, j + 1);
                const int d = vertex(i + 1, j + 1);
                if (j % 2 == 0) {
                    mesh.triangles.insert(mesh.triangles.end(), {{a, b, d}, {a, d, c}});
                } else {
                    mesh.triangles.insert(mesh.triangles.end(), {{a, b, c}, {b, d, c}});
                }
            }
        }
        return mesh;
    }
};

Grid grid_of(const CantileverSample& sample) {
    // The hinges on the clamp's line bend for half an element on each side of it: the strip begins half an
    // element before the line x = 0.
    const double length = sample.length_mm / (sample.columns + 0.5);
    const int rows = std::clamp(static_cast<int>(std::lround(sample.width_mm / length)), 2, sample.columns);
    return {sample.columns, rows, length, sample.width_mm / rows};
}

}  // namespace

CantileverResponse simulate_cantilever(const CantileverSample& sample, const Material& material) {
    if (!(sample.length_mm > 0.0 && sample.width_mm > 0.0 && sample.columns >= 4))
        throw InputError({.key = "sample"}, "length and width must be positive, with four columns or more",
                         "Measure the strip's free length and its width.");
    if (!(material.fabric_areal_density > 0.0))
        throw InputError({.key = "material.fabric_areal_density_kg_per_m2"},
                         "a weightless strip does not hang", "Weigh a piece of known area.");
    constexpr double gravity = 9810.0;  // mm/s^2
    const Grid grid = grid_of(sample);
    ModelInput sheet;
    sheet.mesh = grid.mesh();
    sheet.material = material;
    sheet.prestretch = {1.0, 1.0};
    sheet.fabric_axis_deg = -sample.angle_deg;
    sheet.gravity = {0.0, 0.0, -gravity};
    for (int j = 0; j <= grid.rows; ++j) {
        for (const int i : {-1, 0}) {
            const Vec2& p = sheet.mesh.vertices[grid.vertex(i, j)];
            sheet.supports.push_back({grid.vertex(i, j), {true, true, true}, Vec3(p.x(), p.y(), 0.0)});
        }
    }
    const Equilibrium end = solve(Model(std::move(sheet)));
    CantileverResponse response{.x_mm = 0.5 * grid.length,
                                .converged = end.status == SolveStatus::converged && end.stable};
    for (int j = 0; j <= grid.rows; ++j) {
        const Vec3 tip = end.x.segment<3>(3 * static_cast<Eigen::Index>(grid.vertex(grid.columns, j)));
        response.x_mm += tip.x() / (grid.rows + 1);
        response.y_mm -= tip.z() / (grid.rows + 1);
    }
    return response;
}

}  // namespace ruche
