// The way from flat to released, frame by frame.
#include "ruche/scene/release_film.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "release.hpp"
#include "ruche/scene/read_scene.hpp"
#include "ruche/scene/simulate.hpp"

using namespace ruche;

namespace {

/// Bare strips on a sheet that is cut along them; `size_mm` decides how fine the result's mesh is.
Result strip(double size_mm, int frames) {
    Scene scene = parse_scene(
        "[pattern]\ngenerator = \"strip\"\n[pattern.options]\nlength_mm = 40\n[fabric]\nmargin_mm = 0\n",
        "strip.toml");
    scene.mesh.size_mm = size_mm;
    scene.output.film_frames = frames;
    return simulate(scene);
}

double curvature(const PrintMesh& layout, const std::vector<Vec3>& shape) {
    return measure_strips(layout, shape).at(0).curvature;
}

}  // namespace

TEST_CASE("film: begins flat, curls steadily, ends one step before the result") {
    const Result result = strip(1.0, 8);
    REQUIRE(test::certain(result.equilibrium));
    const auto film = film_release(result);
    REQUIRE(film);
    REQUIRE(film->frames.size() == 8);
    CHECK(film->frames.front().share == 0.0);
    CHECK(film->frames.front().prestretch[0] == 1.0);
    CHECK(std::abs(curvature(film->layout, film->frames.front().shape)) < 1e-9);
    const double final = curvature(result.layout, result.shape);
    double before = 0.0;
    for (const FilmFrame& frame : film->frames) {
        if (frame.share == 0.0) continue;
        const double s = frame.prestretch[0];
        const double full = (1.7 * 1.7 - 1.0) / (2.0 * 1.7 * 1.7);
        CHECK((s * s - 1.0) / (2.0 * s * s) == doctest::Approx(frame.share * full).epsilon(1e-12));
        const double now = curvature(film->layout, frame.shape);
        CHECK(now > before);
        before = now;
    }
    CHECK(before < final);
    CHECK(before > 0.7 * final);
}

TEST_CASE("film: each frame lies as near as it can to the next") {
    const Result result = strip(1.0, 8);
    const auto film = film_release(result);
    REQUIRE(film);
    for (std::size_t i = 0; i + 1 < film->frames.size(); ++i) {
        Vec3 apart = Vec3::Zero();
        for (std::size_t v = 0; v < film->frames[i].shape.size(); ++v)
            apart += film->frames[i].shape[v] - film->frames[i + 1].shape[v];
        CHECK(apart.norm() / static_cast<double>(film->frames[i].shape.size()) < 1e-9);
    }
}

TEST_CASE("film: none where the shape is not converged or none is wanted") {
    Result result = strip(1.0, 0);
    CHECK_FALSE(film_release(result));
    result.scene.output.film_frames = 8;
    result.equilibrium.status = SolveStatus::not_converged;
    CHECK_FALSE(film_release(result));
}

TEST_CASE("film: a fine result is followed on a coarse mesh of the same strips") {
    const Result result = strip(0.15, 4);
    REQUIRE(result.layout.mesh.triangle_count() > 3000);
    const auto film = film_release(result);
    REQUIRE(film);
    CHECK(film->layout.mesh.triangle_count() < 3000);
    CHECK(film->layout.strips.size() == result.layout.strips.size());
    CHECK(curvature(film->layout, film->frames.back().shape) ==
          doctest::Approx(0.75 * curvature(result.layout, result.shape)).epsilon(0.15));
}
