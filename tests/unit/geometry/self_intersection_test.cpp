#include "ruche/geometry/self_intersection.hpp"

#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include "ruche/core/parallel.hpp"

using namespace ruche;

namespace {

struct Surface {
    std::vector<Vec3> positions;
    std::vector<Triangle> triangles;

    void add_sheet(int nu, int nv, const std::function<Vec3(double, double)>& map) {
        const int first = static_cast<int>(positions.size());
        for (int j = 0; j <= nv; ++j) {
            for (int i = 0; i <= nu; ++i) positions.push_back(map(double(i) / nu, double(j) / nv));
        }
        for (int j = 0; j < nv; ++j) {
            for (int i = 0; i < nu; ++i) {
                const int a = first + j * (nu + 1) + i;
                const int b = a + nu + 1;
                triangles.push_back({a, a + 1, b + 1});
                triangles.push_back({a, b + 1, b});
            }
        }
    }
};

std::vector<std::array<int, 2>> pairs_of(const std::vector<Intersection>& found) {
    std::vector<std::array<int, 2>> pairs;
    for (const Intersection& i : found) pairs.push_back(i.triangles);
    return pairs;
}

}  // namespace

TEST_CASE("self-intersection: two crossing triangles are found, and where") {
    Surface s;
    s.positions = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, 1, -1}, {1, 1, 1}, {9, 9, 0.5}};
    s.triangles = {{0, 1, 2}, {3, 4, 5}};
    const auto found = find_self_intersections(s.positions, s.triangles);
    REQUIRE(found.size() == 1);
    CHECK(found[0].triangles == std::array<int, 2>{0, 1});
    CHECK(std::abs(found[0].place.z()) < 1e-9);
    // The second triangle's plane contains (1, 1, 0); the edge to (9, 9, 0.5) crosses at (11/3, 11/3, 0),
    // outside the first, which ends at (2, 2, 0).
    CHECK(found[0].place.isApprox(Vec3(1.5, 1.5, 0)));
}

TEST_CASE("self-intersection: touching in a point, along an edge or within a plane does not count") {
    Surface s;
    s.positions = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}};
    s.triangles = {{0, 1, 2}, {3, 4, 5}};
    SUBCASE("a corner on the face") {
        s.positions.insert(s.positions.end(), {{1, 1, 0}, {1, 1, 2}, {2, 1, 2}});
    }
    SUBCASE("an edge on an edge") {
        s.positions.insert(s.positions.end(), {{1, 0, 0}, {3, 0, 0}, {2, 0, 2}});
    }
    SUBCASE("overlap in the plane") {
        s.positions.insert(s.positions.end(), {{1, 1, 0}, {5, 1, 0}, {1, 5, 0}});
    }
    SUBCASE("near miss") { s.positions.insert(s.positions.end(), {{1, 1, 1e-9}, {1, 1, 2}, {2, 1, 2}}); }
    CHECK(find_self_intersections(s.positions, s.triangles).empty());
}

TEST_CASE("self-intersection: triangles that share one vertex can pass through each other") {
    Surface s;
    s.positions = {{0, 0, 0}, {4, -1, 0}, {4, 1, 0}, {3, 0, -1}, {3, 0, 1}};
    s.triangles = {{0, 1, 2}, {0, 3, 4}};
    CHECK(find_self_intersections(s.positions, s.triangles).size() == 1);
    s.positions[3].z() = 0.5;
    CHECK(find_self_intersections(s.positions, s.triangles).empty());
}

TEST_CASE("self-intersection: flat, bent and spiral sheets are free of it, a closed overlap is not") {
    const auto roll = [](double turns, double growth) {
        return [=](double u, double v) {
            const double angle = 2 * M_PI * turns * u;
            const double radius = 5.0 + growth * u;
            return Vec3(radius * std::cos(angle), radius * std::sin(angle), 10 * v);
        };
    };
    Surface flat;
    flat.add_sheet(20, 10, [](double u, double v) { return Vec3(u, v, 0); });
    CHECK(find_self_intersections(flat.positions, flat.triangles).empty());
    Surface open;
    open.add_sheet(60, 10, roll(0.9, 0.0));
    CHECK(find_self_intersections(open.positions, open.triangles).empty());
    Surface spiral;
    spiral.add_sheet(90, 10, roll(1.5, 2.0));
    CHECK(find_self_intersections(spiral.positions, spiral.triangles).empty());
    Surface overlap;  // the second turn cuts through the first, edges exactly through edges
    overlap.add_sheet(90, 10, [](double u, double v) {
        const double angle = 2 * M_PI * 1.5 * u;
        const double radius = 5.0 + 0.5 * std::sin(0.85 * angle);
        return Vec3(radius * std::cos(angle), radius * std::sin(angle), 10 * v);
    });
    CHECK_FALSE(find_self_intersections(overlap.positions, overlap.triangles).empty());
}

TEST_CASE("self-intersection: in general position it agrees with edges that pierce faces") {
    const auto volume = [](const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
        return (b - a).cross(c - a).dot(d - a);
    };
    const auto pierces = [&](const Vec3& p, const Vec3& q, const std::array<Vec3, 3>& f) {
        if (volume(f[0], f[1], f[2], p) * volume(f[0], f[1], f[2], q) >= 0) return false;
        const double a = volume(p, q, f[0], f[1]);
        const double b = volume(p, q, f[1], f[2]);
        const double c = volume(p, q, f[2], f[0]);
        return (a > 0 && b > 0 && c > 0) || (a < 0 && b < 0 && c < 0);
    };
    std::mt19937 random(4);
    std::uniform_real_distribution<double> uniform(-1, 1);
    int crossing = 0;
    for (int trial = 0; trial < 4000; ++trial) {
        const bool share_vertex = trial % 2 == 1;
        std::vector<Vec3> x(6);
        for (Vec3& p : x) p = Vec3(uniform(random), uniform(random), uniform(random));
        const std::array<Triangle, 2> two = {Triangle{0, 1, 2}, Triangle{share_vertex ? 1 : 3, 4, 5}};
        bool expected = false;
        for (int k = 0; k < 2; ++k) {
            const std::array<Vec3, 3> face = {x[two[1 - k][0]], x[two[1 - k][1]], x[two[1 - k][2]]};
            for (int i = 0; i < 3; ++i) {
                const int p = two[k][i];
                const int q = two[k][(i + 1) % 3];
                const bool at_shared = share_vertex && (p == 1 || q == 1);
                expected = expected || (!at_shared && pierces(x[p], x[q], face));
            }
        }
        crossing += expected;
        REQUIRE(find_self_intersections(x, two).size() == (expected ? 1 : 0));
    }
    CHECK(crossing > 400);
}

TEST_CASE("self-intersection: the tree finds what comparing all pairs finds, at any thread count") {
    std::mt19937 random(2);
    std::uniform_real_distribution<double> uniform(-1, 1);
    Surface s;
    for (int t = 0; t < 300; ++t) {
        const Vec3 at(4 * uniform(random), 4 * uniform(random), 4 * uniform(random));
        const int first = static_cast<int>(s.positions.size());
        for (int k = 0; k < 3; ++k)
            s.positions.emplace_back(at + Vec3(uniform(random), uniform(random), uniform(random)));
        s.triangles.push_back({first, first + 1, first + 2});
    }
    std::vector<std::array<int, 2>> expected;
    for (int a = 0; a < 300; ++a) {
        for (int b = a + 1; b < 300; ++b) {
            std::vector<Vec3> six;
            for (const int t : {a, b}) {
                for (const int v : s.triangles[t]) six.push_back(s.positions[v]);
            }
            const std::array<Triangle, 2> two = {Triangle{0, 1, 2}, Triangle{3, 4, 5}};
            if (!find_self_intersections(six, two).empty()) expected.push_back({a, b});
        }
    }
    REQUIRE(expected.size() > 20);
    const int before = thread_count();
    for (const int threads : {1, 3}) {
        set_thread_count(threads);
        CHECK(pairs_of(find_self_intersections(s.positions, s.triangles)) == expected);
    }
    set_thread_count(before);
}

TEST_CASE("self-intersection: positions that are not finite intersect nothing") {
    Surface s;
    s.positions = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, 1, -1}, {1, 1, 1}, {9, 9, 0.5}};
    s.triangles = {{0, 1, 2}, {3, 4, 5}};
    s.positions[4].x() = std::numeric_limits<double>::quiet_NaN();
    CHECK(find_self_intersections(s.positions, s.triangles).empty());
    CHECK(find_self_intersections({}, {}).empty());
}
