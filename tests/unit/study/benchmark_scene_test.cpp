#include "ruche/study/benchmark_scene.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>

#include "ruche/core/error.hpp"
#include "ruche/scene/build.hpp"
#include "ruche/scene/check_scene.hpp"

using namespace ruche;

TEST_CASE("benchmark scenes: each is a sound scene with the strips that it names") {
    const std::map<std::string_view, std::size_t> strips = {
        {"strips", 5}, {"staggered", 58}, {"torus", 80},
        {"stars", 12}, {"svg", 80},       {"fivestrips-without-log-terms", 5}};
    CHECK(benchmark_scenes().size() == strips.size());
    for (const BenchmarkSceneInfo& info : benchmark_scenes()) {
        CAPTURE(info.name);
        const BenchmarkScene made(info.name);
        CHECK_NOTHROW(check_scene(made.scene()));
        CHECK(scene_pattern(made.scene()).strips.size() == strips.at(info.name));
        CHECK_FALSE(info.meaning.empty());
    }
}

TEST_CASE("benchmark scenes: the mesh has about as many triangles as asked for") {
    for (const int wanted : {3000, 9000}) {
        BenchmarkScene made("strips");
        made.resize(wanted);
        CHECK(std::abs(1.0 * scene_mesh(made.scene()).mesh.triangle_count() / wanted - 1.0) < 0.05);
    }
}

TEST_CASE(
    "benchmark scenes: too few triangles for a pattern, and names that are not there, are mistakes of "
    "input") {
    BenchmarkScene torus("torus");
    CHECK_THROWS_WITH_AS(torus.resize(100), doctest::Contains("about 100 triangles"), InputError);
    CHECK_THROWS_WITH_AS(BenchmarkScene("star"), doctest::Contains("did you mean stars"), InputError);
}

TEST_CASE("benchmark scenes: what lies in the temporary folder goes with the scene") {
    std::filesystem::path drawing;
    {
        const BenchmarkScene made("svg");
        drawing = made.scene().pattern.svg;
        CHECK(std::filesystem::exists(drawing));
    }
    CHECK_FALSE(std::filesystem::exists(drawing.parent_path()));
}

TEST_CASE("benchmark scenes: the strips without logarithms differ from the strips in nothing else") {
    const BenchmarkScene with("strips");
    const BenchmarkScene without("fivestrips-without-log-terms");
    CHECK(with.scene().material.beta_1 > 0.0);
    CHECK(without.scene().material.beta_1 == 0.0);
    CHECK(without.scene().material.beta_2 == 0.0);
    CHECK(without.scene().material.alpha_1 == with.scene().material.alpha_1);
    CHECK(scene_mesh(with.scene()).mesh.vertices == scene_mesh(without.scene()).mesh.vertices);
    for (const Strip& strip : scene_pattern(with.scene()).strips) {
        CHECK(strip.thickness == 1.0);
        CHECK(area(strip.region) == doctest::Approx(60.0));
    }
}
