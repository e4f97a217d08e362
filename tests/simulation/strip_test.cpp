// A single strip without fabric around it, against the closed forms (theory page, "Closed forms").
#include <doctest/doctest.h>

#include <cmath>

#include "release.hpp"
#include "ruche/meshing/print_mesh.hpp"

using namespace ruche;
using namespace ruche::test;

namespace {

double strip_curvature(PrintMesh layout, const ModelInput& input = {}) {
    add_strip(layout, "strip", {0.0, 0.5}, {30.0, 0.5});
    const Equilibrium state = release(layout, input);
    REQUIRE(certain(state));
    return measure_strips(layout, positions(state, layout)).at(0).curvature;
}

PrintMesh rectangle(MeshKind kind, int across, double thickness) {
    return printed(rectangle_mesh(kind, {.length = 30.0, .width = 1.0, .across = across}),
                   [=](const Vec2&) { return thickness; });
}

PrintMesh delaunay(double size, double thickness) {
    const Polygon box{{{0, 0}, {30, 0}, {30, 1}, {0, 1}}, {}};
    Pattern pattern{.fabric = {box}, .strips = {{.id = "strip", .region = {box}, .thickness = thickness}}};
    PrintMesh layout = mesh_pattern(pattern, {.size_mm = size});
    layout.strips.clear();
    return layout;
}

}  // namespace

TEST_CASE("closed form: the test's own formula gives the theory page's values") {
    CHECK(bimetal_curvature({}, 1.7, 0.6) == doctest::Approx(0.152362385).epsilon(1e-8));
    CHECK(bimetal_curvature({}, 1.7, 1.0) == doctest::Approx(0.051255722).epsilon(1e-7));
}

TEST_CASE("strip: curvature is the bimetal's on every kind of mesh and any number of elements across") {
    for (const double thickness : {0.4, 0.6, 1.0, 1.2}) {
        // At 0.4 mm the finite width of the strip shows already.
        const double tolerance = thickness < 0.5 ? 0.007 : 0.003;
        const double exact = bimetal_curvature({}, 1.7, thickness);
        for (const MeshKind kind :
             {MeshKind::lattice, MeshKind::alternating, MeshKind::criss_cross, MeshKind::jittered}) {
            for (const int across : {1, 2, 4}) {
                CAPTURE(thickness);
                CAPTURE(across);
                CAPTURE(static_cast<int>(kind));
                CHECK(strip_curvature(rectangle(kind, across, thickness)) ==
                      doctest::Approx(exact).epsilon(tolerance));
            }
        }
        for (const double size : {1.0, 0.5, 0.25}) {
            CAPTURE(size);
            CHECK(strip_curvature(delaunay(size, thickness)) == doctest::Approx(exact).epsilon(tolerance));
        }
    }
}

TEST_CASE("strip: printed on the back it is the mirror image") {
    const double front = strip_curvature(rectangle(MeshKind::alternating, 2, 0.8));
    const double back = strip_curvature(rectangle(MeshKind::alternating, 2, -0.8));
    CHECK(front > 0.0);  // concave towards the back: the fabric is on the concave side
    CHECK(back == doctest::Approx(-front).epsilon(1e-6));
}

TEST_CASE("strip: stays flat without pre-stretch") {
    ModelInput input;
    input.prestretch = {1.0, 1.0};
    CHECK(std::abs(strip_curvature(rectangle(MeshKind::jittered, 2, 0.6), input)) < 1e-9);
}

TEST_CASE("strip: a wide thin one takes the lower of its two stable shapes from every seed") {
    // 60 x 5 mm, 0.3 mm: rolled along its length about 43.1 mJ, across its width 45.0 mJ.
    const PrintMesh layout =
        printed(rectangle_mesh(MeshKind::alternating, {.length = 60.0, .width = 5.0, .across = 5}),
                [](const Vec2&) { return 0.3; });
    const Equilibrium first = release(layout, {}, {.seed = 1});
    REQUIRE(certain(first));
    CHECK(first.energy.total() < 44.0);
    for (const int seed : {2, 3, 4, 5}) {
        const Equilibrium state = release(layout, {}, {.seed = seed});
        CHECK(certain(state));
        CHECK(state.energy.total() == doctest::Approx(first.energy.total()).epsilon(1e-9));
    }
}
