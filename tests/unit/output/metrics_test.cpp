#include "ruche/output/metrics.hpp"

#include <doctest/doctest.h>

#include <Eigen/Dense>
#include <cmath>
#include <functional>
#include <random>

using namespace ruche;

namespace {

enum class Kind { lattice, alternating, irregular };

/// A strip [0, length] x [-width/2, width/2] meshed with `across` elements of about `size` mm.
PrintMesh strip_mesh(double length, double width, int along, int across, Kind kind) {
    PrintMesh result;
    TriangleMesh& mesh = result.mesh;
    std::mt19937 random(7);
    std::uniform_real_distribution<double> jitter(-0.3, 0.3);
    for (int j = 0; j <= across; ++j) {
        for (int i = 0; i <= along; ++i) {
            Vec2 x(length * i / along, width * (double(j) / across - 0.5));
            const bool end = i == 0 || i == along;
            if (kind == Kind::irregular && !end) x.x() += jitter(random) * length / along;
            if (kind == Kind::irregular && j > 0 && j < across) x.y() += jitter(random) * width / across;
            mesh.vertices.push_back(x);
        }
    }
    for (int j = 0; j < across; ++j) {
        for (int i = 0; i < along; ++i) {
            const int a = j * (along + 1) + i;
            const int b = a + along + 1;
            const bool other =
                kind == Kind::alternating ? (i + j) % 2 == 1 : kind == Kind::irregular && random() % 2;
            if (other) {
                mesh.triangles.push_back({a, a + 1, b});
                mesh.triangles.push_back({a + 1, b + 1, b});
            } else {
                mesh.triangles.push_back({a, a + 1, b + 1});
                mesh.triangles.push_back({a, b + 1, b});
            }
        }
    }
    result.print.assign(mesh.triangles.size(), {.front = 0.6});
    result.strip.assign(mesh.triangles.size(), {.front = 0});
    return result;
}

MeshPoint locate(const TriangleMesh& mesh, const Vec2& x) {
    for (int t = 0; t < mesh.triangle_count(); ++t) {
        const Triangle& tri = mesh.triangles[t];
        Mat2 m;
        m << mesh.vertices[tri[1]] - mesh.vertices[tri[0]], mesh.vertices[tri[2]] - mesh.vertices[tri[0]];
        const Vec2 w = m.inverse() * (x - mesh.vertices[tri[0]]);
        if (w.minCoeff() > -1e-9 && w.sum() < 1 + 1e-9) return {t, {1 - w.sum(), w[0], w[1]}};
    }
    return {};
}

/// Adds a strip whose centre line is sampled at `count` points of curve(u), u in [0, 1].
void add_strip(PrintMesh& mesh, int count, const std::function<Vec2(double)>& curve) {
    MeshedStrip strip{.id = "strip-" + std::to_string(mesh.strips.size() + 1), .thickness = 0.6};
    strip.centreline.emplace_back();
    for (int i = 0; i < count; ++i)
        strip.centreline.back().push_back(locate(mesh.mesh, curve(double(i) / (count - 1))));
    mesh.strips.push_back(strip);
}

std::vector<Vec3> map_vertices(const PrintMesh& mesh, const std::function<Vec3(const Vec2&)>& map) {
    std::vector<Vec3> shape;
    for (const Vec2& x : mesh.mesh.vertices) shape.push_back(map(x));
    return shape;
}

/// Rolls the sheet about the y direction; curvature > 0: downwards, the back is concave.
std::function<Vec3(const Vec2&)> roll(double curvature) {
    return [=](const Vec2& x) {
        const double angle = curvature * x.x();
        return Vec3(std::sin(angle) / curvature, x.y(), (std::cos(angle) - 1.0) / curvature);
    };
}

}  // namespace

TEST_CASE("strip metrics: a strip rolled to a cylinder has the cylinder's curvature on every mesh") {
    for (const Kind kind : {Kind::lattice, Kind::alternating, Kind::irregular}) {
        for (const int across : {1, 2, 3}) {
            for (const double curvature : {0.15, 0.05, -0.2}) {
                CAPTURE(static_cast<int>(kind));
                CAPTURE(across);
                CAPTURE(curvature);
                PrintMesh mesh = strip_mesh(30, 1, 30, across, kind);
                add_strip(mesh, 71, [](double u) { return Vec2(30 * u, 0.0); });
                const StripMetrics m = measure_strips(mesh, map_vertices(mesh, roll(curvature))).front();
                // What is left is of second order in the correction itself, sagitta / radius = 0.3 %.
                CHECK(m.curvature == doctest::Approx(curvature).epsilon(2e-5));
                CHECK(m.radius == doctest::Approx(1.0 / std::abs(curvature)).epsilon(2e-5));
                CHECK(m.fit_rms < 1e-3);
                // Chords are shorter than arcs by kappa^2 l^2 / 24, elements up to 1.6 mm long.
                CHECK(m.stretch < 1.0);
                CHECK(m.stretch > 1.0 - std::pow(curvature * 1.6, 2) / 24);
                CHECK(m.printed_length == doctest::Approx(30.0));
            }
        }
    }
}

TEST_CASE("strip metrics: the number of samples does not move the curvature") {
    PrintMesh mesh = strip_mesh(30, 1, 15, 1, Kind::lattice);  // 2 mm elements: 0.3 rad each
    for (const int count : {31, 47, 200}) add_strip(mesh, count, [](double u) { return Vec2(30 * u, 0.0); });
    for (const StripMetrics& m : measure_strips(mesh, map_vertices(mesh, roll(0.15))))
        CHECK(m.curvature == doctest::Approx(0.15).epsilon(2e-4));
}

TEST_CASE("strip metrics: more than one turn is no trouble") {
    PrintMesh mesh = strip_mesh(90, 1, 120, 1, Kind::alternating);
    add_strip(mesh, 300, [](double u) { return Vec2(90 * u, 0.0); });
    const StripMetrics m = measure_strips(mesh, map_vertices(mesh, roll(0.15))).front();
    CHECK(m.curvature == doctest::Approx(0.15).epsilon(2e-5));
}

TEST_CASE("strip metrics: a flat strip has no radius, and its stretch is that of the sheet") {
    PrintMesh mesh = strip_mesh(30, 1, 30, 1, Kind::lattice);
    add_strip(mesh, 61, [](double u) { return Vec2(30 * u, 0.0); });
    const auto shape = map_vertices(mesh, [](const Vec2& x) { return Vec3(0.9 * x.x(), 0.7 * x.y(), 4.0); });
    const StripMetrics m = measure_strips(mesh, shape).front();
    CHECK(std::abs(m.curvature) < 1e-10);
    CHECK(std::isinf(m.radius));
    CHECK(m.stretch == doctest::Approx(0.9).epsilon(1e-12));
}

TEST_CASE("strip metrics: an arc drawn in the layout is flat while the sheet is flat") {
    PrintMesh mesh = strip_mesh(20, 20, 40, 40, Kind::irregular);
    add_strip(mesh, 150,
              [](double u) { return Vec2(10 + 8 * std::cos(M_PI * u), -4 + 8 * std::sin(M_PI * u)); });
    const auto shape = map_vertices(mesh, [](const Vec2& x) { return Vec3(x.x(), x.y(), 0.0); });
    const StripMetrics m = measure_strips(mesh, shape).front();
    CHECK(std::abs(m.curvature) < 1e-12);
}

TEST_CASE("strip metrics: on a cylinder a slanted strip has Euler's normal curvature") {
    PrintMesh mesh = strip_mesh(20, 20, 40, 40, Kind::irregular);
    const double angle = 40.0 * M_PI / 180.0;
    add_strip(mesh, 81, [=](double u) {
        return Vec2(10 + 16 * (u - 0.5) * std::cos(angle), 16 * (u - 0.5) * std::sin(angle));
    });
    // A helix: its projection to its principal plane is only nearly a circle over this length (0.6 rad).
    const StripMetrics m = measure_strips(mesh, map_vertices(mesh, roll(0.05))).front();
    CHECK(m.curvature == doctest::Approx(0.05 * std::cos(angle) * std::cos(angle)).epsilon(5e-3));
}

TEST_CASE("strip metrics: a ring on a sphere has the sphere's curvature whatever its own") {
    PrintMesh mesh = strip_mesh(20, 20, 40, 40, Kind::lattice);
    add_strip(mesh, 200,
              [](double u) { return Vec2(10 + 6 * std::cos(2 * M_PI * u), 6 * std::sin(2 * M_PI * u)); });
    const double radius = 25.0;
    const auto shape = map_vertices(mesh, [=](const Vec2& x) {
        const Vec2 from(x.x() - 10, x.y());
        const double r = std::max(from.norm(), 1e-12);
        const double polar = r / radius;  // geodesic distance kept
        return Vec3(radius * std::sin(polar) * from.x() / r, radius * std::sin(polar) * from.y() / r,
                    radius * (std::cos(polar) - 1));
    });
    const StripMetrics m = measure_strips(mesh, shape).front();
    CHECK(m.curvature == doctest::Approx(1 / radius).epsilon(0.02));
}

TEST_CASE("strip metrics: corners of the drawing are not bends of the sheet") {
    PrintMesh mesh = strip_mesh(20, 20, 40, 40, Kind::lattice);
    // Along x on a cylinder about y, then along y, which stays straight: equal lengths, half the curvature.
    add_strip(mesh, 64, [](double u) {
        const double s = 16.1 * u;
        return s < 8 ? Vec2(2 + s, -4) : Vec2(10, -4 + (s - 8));
    });
    const StripMetrics m = measure_strips(mesh, map_vertices(mesh, roll(0.1))).front();
    CHECK(m.curvature == doctest::Approx(0.05).epsilon(0.03));
    CHECK(m.fit_rms < 0.01);
}

TEST_CASE("strip metrics: a strip without a centre line has no numbers, the others keep theirs") {
    PrintMesh mesh = strip_mesh(30, 1, 30, 1, Kind::lattice);
    mesh.strips.push_back({.id = "blob"});
    add_strip(mesh, 61, [](double u) { return Vec2(30 * u, 0.0); });
    const auto metrics = measure_strips(mesh, map_vertices(mesh, roll(0.1)));
    REQUIRE(metrics.size() == 2);
    CHECK(metrics[0].id == "blob");
    CHECK(std::isnan(metrics[0].curvature));
    CHECK(std::isnan(metrics[0].radius));
    CHECK(std::isnan(metrics[0].stretch));
    CHECK(metrics[1].curvature == doctest::Approx(0.1).epsilon(2e-5));
}

TEST_CASE("strip metrics: two lines of one strip are averaged by their length") {
    PrintMesh mesh = strip_mesh(30, 1, 30, 1, Kind::lattice);
    add_strip(mesh, 41, [](double u) { return Vec2(20 * u, 0.0); });
    add_strip(mesh, 21, [](double u) { return Vec2(20 + 10 * u, 0.0); });
    mesh.strips[0].centreline.push_back(mesh.strips[1].centreline[0]);
    mesh.strips.pop_back();
    // Bent by 0.1 up to x = 20, straight beyond.
    const auto shape = map_vertices(mesh, [](const Vec2& x) {
        const double rest = std::max(0.0, x.x() - 20.0);
        const Vec3 p = roll(0.1)({std::min(x.x(), 20.0), x.y()});
        return Vec3(p + rest * Vec3(std::cos(2.0), 0.0, -std::sin(2.0)));
    });
    CHECK(measure_strips(mesh, shape).front().curvature == doctest::Approx(0.1 * 20 / 30).epsilon(1e-4));
}

TEST_CASE("shape metrics: box and areas") {
    PrintMesh mesh = strip_mesh(30, 2, 30, 2, Kind::alternating);
    mesh.print[0] = {};
    const auto shape = map_vertices(mesh, [](const Vec2& x) { return Vec3(0.5 * x.x(), x.y(), 3.0); });
    const ShapeMetrics m = measure_shape(mesh, shape);
    CHECK(m.box_min.isApprox(Vec3(0, -1, 3)));
    CHECK(m.box_max.isApprox(Vec3(15, 1, 3)));
    CHECK(m.layout_area == doctest::Approx(60));
    CHECK(m.area == doctest::Approx(30));
    CHECK(m.printed_area == doctest::Approx(59.5));
}

TEST_CASE("strip metrics: their rates are the derivatives along the vertices' velocities") {
    PrintMesh mesh = strip_mesh(20, 20, 20, 20, Kind::irregular);
    add_strip(mesh, 41, [](double u) { return Vec2(2 + 16 * u, 1.0); });
    add_strip(mesh, 41, [](double u) { return Vec2(3 + 9 * u, -4 + 9 * u); });  // slanted
    add_strip(mesh, 81, [](double u) {                                          // in several pieces
        return Vec2(10 + 6 * std::cos(M_PI * u), 6 * std::sin(M_PI * u));
    });
    mesh.strips.push_back({.id = "blob"});
    std::mt19937 random(3);
    std::normal_distribution<double> normal;
    std::vector<Vec3> velocities;
    for (std::size_t v = 0; v < mesh.mesh.vertices.size(); ++v)
        velocities.emplace_back(normal(random), normal(random), normal(random));
    for (const double curvature : {0.1, -0.2}) {
        CAPTURE(curvature);
        const std::vector<Vec3> rest = map_vertices(mesh, [&](const Vec2& x) {
            return Vec3(roll(curvature)(x) + 0.02 * Vec3(0, 0, std::sin(x.y())));
        });
        const auto moved = [&](double t) {
            std::vector<Vec3> shape = rest;
            for (std::size_t v = 0; v < shape.size(); ++v) shape[v] += t * velocities[v];
            return measure_strips(mesh, shape);
        };
        const std::vector<StripRates> rates = strip_rates(mesh, rest, velocities);
        REQUIRE(rates.size() == 4);
        const double h = 4e-5;  // the plane of a short arc turns fast: small steps
        const auto wide = std::array{moved(h), moved(-h)};
        const auto narrow = std::array{moved(0.5 * h), moved(-0.5 * h)};
        for (std::size_t i = 0; i < 3; ++i) {
            CAPTURE(i);
            const auto richardson = [&](double StripMetrics::*of) {
                const double coarse = (wide[0][i].*of - wide[1][i].*of) / (2 * h);
                const double fine = (narrow[0][i].*of - narrow[1][i].*of) / h;
                return (4 * fine - coarse) / 3;
            };
            CHECK(rates[i].curvature == doctest::Approx(richardson(&StripMetrics::curvature)).epsilon(1e-7));
            CHECK(rates[i].stretch == doctest::Approx(richardson(&StripMetrics::stretch)).epsilon(1e-7));
        }
        CHECK(std::isnan(rates[3].curvature));
    }
    const std::vector<Vec3> flat = map_vertices(mesh, [](const Vec2& x) { return Vec3(x.x(), x.y(), 0); });
    CHECK(std::isnan(strip_rates(mesh, flat, velocities)[0].curvature));
}
