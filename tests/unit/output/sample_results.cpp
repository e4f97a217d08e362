#include "output/sample_results.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace ruche::sample {

using std::numbers::pi;

TriangleMesh grid(const GridOptions& options) {
    TriangleMesh mesh;
    std::mt19937 random(7);  // its sequence is fixed by the standard, those of distributions are not
    const auto noise = [&] { return options.jitter * (random() / 4294967295.0 - 0.5); };
    for (int j = 0; j <= options.ny; ++j)
        for (int i = 0; i <= options.nx; ++i) {
            const bool inner = i > 0 && j > 0 && i < options.nx && j < options.ny;
            const double du = inner ? noise() : 0.0, dv = inner ? noise() : 0.0;
            mesh.vertices.emplace_back((i + du) * options.width / options.nx,
                                       (j + dv) * options.height / options.ny);
        }
    const auto at = [&](int i, int j) { return j * (options.nx + 1) + i; };
    for (int j = 0; j < options.ny; ++j)
        for (int i = 0; i < options.nx; ++i) {
            const int a = at(i, j), b = at(i + 1, j), c = at(i + 1, j + 1), d = at(i, j + 1);
            if ((i + j) % 2 == 0) {
                mesh.triangles.push_back({a, b, c});
                mesh.triangles.push_back({a, c, d});
            } else {
                mesh.triangles.push_back({a, b, d});
                mesh.triangles.push_back({b, c, d});
            }
        }
    return mesh;
}

Result result(TriangleMesh mesh, const std::vector<SampleStrip>& strips,
              const std::function<Vec3(const Vec2&)>& shape) {
    Result r;
    r.layout.mesh = std::move(mesh);
    for (const SampleStrip& s : strips)
        r.layout.strips.push_back({.id = s.id,
                                   .side = s.print.front > 0.0 ? Side::front : Side::back,
                                   .thickness = std::max(s.print.front, s.print.back)});
    for (const Triangle& t : r.layout.mesh.triangles) {
        const auto& v = r.layout.mesh.vertices;
        const Vec2 centroid = (v[t[0]] + v[t[1]] + v[t[2]]) / 3.0;
        int on = -1;
        for (std::size_t s = 0; s < strips.size(); ++s)
            if (strips[s].covers(centroid)) on = static_cast<int>(s);
        const Print print = on < 0 ? Print{} : strips[on].print;
        r.layout.strip.push_back({.front = print.front > 0.0 ? on : -1, .back = print.back > 0.0 ? on : -1});
        r.layout.print.push_back(print);
    }
    for (const Vec2& v : r.layout.mesh.vertices) r.shape.push_back(shape(v));
    r.scene.file = "sample.toml";
    r.equilibrium.status = SolveStatus::converged;
    r.equilibrium.stable = true;
    return r;
}

Result rolled_sheet(double radius, int cells_per_mm) {
    const auto band = [](double low, double high) {
        return [=](const Vec2& p) { return p.x() > 2 && p.x() < 28 && p.y() > low && p.y() < high; };
    };
    return result(grid({.nx = 30 * cells_per_mm, .ny = 20 * cells_per_mm}),
                  {{"front strip", band(3, 5), {.front = 0.6}},
                   {"back strip", band(9, 11), {.back = 0.8}},
                   {"both", band(15, 17), {.front = 0.4, .back = 0.5}}},
                  [radius](const Vec2& p) {
                      const double angle = p.x() / radius;
                      return Vec3(radius * std::sin(angle), p.y(), radius * std::cos(angle));
                  });
}

namespace {

/// Rings of quads, cut into triangles, between two radii (a disc when `inner` is tiny).
TriangleMesh annulus(double inner, double outer, int rings, int around) {
    TriangleMesh mesh;
    for (int i = 0; i <= rings; ++i)
        for (int j = 0; j < around; ++j) {
            const double r = inner + (outer - inner) * i / rings, a = 2 * pi * j / around;
            mesh.vertices.emplace_back(r * std::cos(a), r * std::sin(a));
        }
    for (int i = 0; i < rings; ++i)
        for (int j = 0; j < around; ++j) {
            const int a = i * around + j, b = i * around + (j + 1) % around;
            const int c = b + around, d = a + around;
            mesh.triangles.push_back({a, d, c});
            mesh.triangles.push_back({a, c, b});
        }
    return mesh;
}

}  // namespace

Result half_torus(int rings) {
    const auto ray = [](int count, double phase, double from) {
        return [=](const Vec2& p) {
            const double turn = std::atan2(p.y(), p.x()) / (2 * pi) * count - phase;
            const double off = (turn - std::round(turn)) * 2 * pi / count * p.norm();
            return std::abs(off) < 0.5 && p.norm() > from && p.norm() < 33.5;
        };
    };
    return result(annulus(12, 34, rings, 480),
                  {{"20 long", ray(20, 0.0, 12.5), {.front = 0.7}},
                   {"20 middle", ray(20, 0.5, 16.5), {.front = 0.7}},
                   {"40 short", ray(40, 0.5, 22.0), {.front = 0.7}}},
                  [](const Vec2& p) {
                      const double angle = pi * (p.norm() - 12.0) / 22.0, tube = 5.5, centre = 14.0;
                      const double r = centre - tube * std::cos(angle);
                      return Vec3(r * p.x() / p.norm(), r * p.y() / p.norm(), tube * std::sin(angle));
                  });
}

Result star_dome(int rings) {
    const auto star = [](const Vec2& p) {
        constexpr double edge = 6.4, arm = 2.9, half_width = 0.6;
        // Centres of a hexagonal tiling: corners of hexagons, two per cell of a triangular lattice.
        const double step = edge * std::sqrt(3.0);
        for (int i = -5; i <= 5; ++i)
            for (int j = -5; j <= 5; ++j)
                for (int k = 0; k < 2; ++k) {
                    const Vec2 centre(step * (i + 0.5 * j), edge * (1.5 * j + k));
                    const Vec2 d = p - centre;
                    for (int a = 0; a < 3; ++a) {
                        const double angle = pi / 2 * (k == 0 ? -1 : 1) + 2 * pi * a / 3;
                        const Vec2 along(std::cos(angle), std::sin(angle));
                        const double t = along.dot(d);
                        if (t > -0.3 && t < arm &&
                            std::abs(along.x() * d.y() - along.y() * d.x()) < half_width)
                            return true;
                    }
                }
        return false;
    };
    return result(annulus(0.05, 19, rings, 300), {{"stars", star, {.front = 0.8}}}, [](const Vec2& p) {
        const double angle = p.norm() / 13.0, radius = 10.0;
        return Vec3(radius * std::sin(angle) * p.x() / p.norm(), radius * std::sin(angle) * p.y() / p.norm(),
                    radius * std::cos(angle));
    });
}

}  // namespace ruche::sample
