#include "ruche/meshing/structured.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "ruche/core/error.hpp"
#include "ruche/geometry/polyline.hpp"
#include "ruche/meshing/point_locator.hpp"

namespace ruche {

namespace {

/// A grid of `columns` x `rows` cells over the rectangle.
struct Grid {
    double length, width;
    int columns, rows;

    Vec2 at(double i, double j) const { return {length * i / columns, width * j / rows}; }
    int vertex(int i, int j) const { return j * (columns + 1) + i; }
};

Grid grid_of(const RectangleOptions& options, double cell_length) {
    const double columns = std::max(1.0, std::round(options.length / cell_length));
    return {options.length, options.width, static_cast<int>(columns), options.across};
}

// Every other row is shifted by half an edge, with points at both ends so that the border stays straight.
TriangleMesh lattice(const RectangleOptions& options) {
    const double height = options.width / options.across;
    const Grid grid = grid_of(options, height * 2.0 / std::numbers::sqrt3);
    TriangleMesh mesh;
    std::vector<std::vector<int>> rows;
    for (int j = 0; j <= grid.rows; ++j) {
        std::vector<double> places;
        for (int i = 0; i <= grid.columns; ++i) {
            if (j % 2 == 1 && i > 0) places.push_back(i - 0.5);
            if (j % 2 == 0 || i == 0 || i == grid.columns) places.push_back(i);
        }
        rows.emplace_back();
        for (const double i : places) {
            rows.back().push_back(mesh.vertex_count());
            mesh.vertices.push_back(grid.at(i, j));
        }
    }
    for (int j = 0; j < grid.rows; ++j) {
        const bool even_below = j % 2 == 0;
        const std::vector<int>& even = even_below ? rows[j] : rows[j + 1];
        const std::vector<int>& odd = even_below ? rows[j + 1] : rows[j];
        const auto add = [&](int a, int b, int c) {
            mesh.triangles.push_back(even_below ? Triangle{a, b, c} : Triangle{a, c, b});
        };
        for (std::size_t k = 0; k < even.size(); ++k) {
            add(even[k], odd[k + 1], odd[k]);
            if (k + 1 < even.size()) add(even[k], even[k + 1], odd[k + 1]);
        }
    }
    return mesh;
}

TriangleMesh alternating(const Grid& grid) {
    TriangleMesh mesh;
    for (int j = 0; j <= grid.rows; ++j) {
        for (int i = 0; i <= grid.columns; ++i) mesh.vertices.push_back(grid.at(i, j));
    }
    for (int j = 0; j < grid.rows; ++j) {
        for (int i = 0; i < grid.columns; ++i) {
            const int a = grid.vertex(i, j);
            const int b = grid.vertex(i + 1, j);
            const int c = grid.vertex(i + 1, j + 1);
            const int d = grid.vertex(i, j + 1);
            if ((i + j) % 2 == 0) {
                mesh.triangles.insert(mesh.triangles.end(), {{a, b, c}, {a, c, d}});
            } else {
                mesh.triangles.insert(mesh.triangles.end(), {{a, b, d}, {b, c, d}});
            }
        }
    }
    return mesh;
}

TriangleMesh criss_cross(const Grid& grid) {
    TriangleMesh mesh;
    for (int j = 0; j <= grid.rows; ++j) {
        for (int i = 0; i <= grid.columns; ++i) mesh.vertices.push_back(grid.at(i, j));
    }
    for (int j = 0; j < grid.rows; ++j) {
        for (int i = 0; i < grid.columns; ++i) {
            const int corners[4] = {grid.vertex(i, j), grid.vertex(i + 1, j), grid.vertex(i + 1, j + 1),
                                    grid.vertex(i, j + 1)};
            const int centre = mesh.vertex_count();
            mesh.vertices.push_back(grid.at(i + 0.5, j + 0.5));
            for (int k = 0; k < 4; ++k) mesh.triangles.push_back({corners[k], corners[(k + 1) % 4], centre});
        }
    }
    return mesh;
}

void jitter(TriangleMesh& mesh, const Grid& grid, const RectangleOptions& options) {
    const double reach = options.jitter * std::min(grid.length / grid.columns, grid.width / grid.rows);
    std::mt19937_64 random(options.seed);
    // std::uniform_real_distribution differs between standard libraries; the generator itself does not.
    const auto uniform = [&] { return static_cast<double>(random() >> 11U) * 0x1.0p-53; };
    for (int j = 0; j <= grid.rows; ++j) {
        for (int i = 0; i <= grid.columns; ++i) {
            const double angle = 2.0 * std::numbers::pi * uniform();
            const double distance = reach * std::sqrt(uniform());
            Vec2& v = mesh.vertices[grid.vertex(i, j)];
            if (i > 0 && i < grid.columns) v.x() += distance * std::cos(angle);
            if (j > 0 && j < grid.rows) v.y() += distance * std::sin(angle);
        }
    }
}

}  // namespace

TriangleMesh rectangle_mesh(MeshKind kind, const RectangleOptions& options) {
    const bool sizes_fit = options.length > 0.0 && options.width > 0.0 && options.across > 0 &&
                           std::isfinite(options.length) && std::isfinite(options.width) &&
                           options.length / options.width * options.across < 1e6;
    if (!sizes_fit || !(options.jitter >= 0.0 && options.jitter < 0.35)) {
        throw InputError(
            {},
            fmt::format("cannot mesh a rectangle of {} x {} mm with {} elements across and a jitter "
                        "of {}",
                        options.length, options.width, options.across, options.jitter),
            "Sizes are positive; the jitter is at least 0 and below 0.35.");
    }
    if (kind == MeshKind::lattice) return lattice(options);
    const Grid grid = grid_of(options, options.width / options.across);
    if (kind == MeshKind::criss_cross) return criss_cross(grid);
    TriangleMesh mesh = alternating(grid);
    if (kind == MeshKind::jittered) jitter(mesh, grid, options);
    return mesh;
}

std::vector<MeshPoint> points_on_mesh(const TriangleMesh& mesh, const Polyline& line, int count) {
    const PointLocator locator(mesh);
    std::vector<MeshPoint> points;
    for (const Vec2& p : resample(line, false, count)) {
        // Points on the border may be off by rounding.
        if (const std::optional<MeshPoint> at = locator.find(p, 1e-9)) points.push_back(*at);
    }
    return points;
}

}  // namespace ruche
