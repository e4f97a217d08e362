#include "ruche/scene/preview.hpp"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include "ruche/scene/build.hpp"
#include "ruche/scene/read_scene.hpp"

using namespace ruche;

namespace {

int preview_triangles(const Scene& scene) {
    return scene_mesh(preview_scene(scene, 1500.0)).mesh.triangle_count();
}

}  // namespace

TEST_CASE("preview: the thinner the strips the fewer of their elements, wide ones take what was asked for") {
    const auto strips = [](double width) {
        return parse_scene(fmt::format("pattern.generator = \"staggered\"\n"
                                       "pattern.options = {{ width_mm = {} }}\n",
                                       width),
                           "test.toml");
    };
    for (const double width : {0.4, 0.6, 1.0, 1.5}) {
        CAPTURE(width);
        const int full = scene_mesh(strips(width)).mesh.triangle_count();
        const int coarse = preview_triangles(strips(width));
        // Elements twice as long are half as many, and each strip rounds their number up.
        CHECK(coarse < 0.6 * full);
        if (width < 0.5) CHECK(coarse < full / 3);
        if (width >= 1.5) CHECK(coarse < 2500);
    }
}

TEST_CASE("preview: a scene that is coarse already stays as it is") {
    Scene scene = parse_scene("pattern.generator = \"strip\"\npattern.options.width_mm = 2\n", "test.toml");
    scene.model.contact = true;
    scene.solver.max_iterations = 20;
    const Scene preview = preview_scene(scene, 1500.0);
    CHECK(preview.mesh.size_mm == scene.mesh.size_mm);
    CHECK(preview.mesh.elements_across == scene.mesh.elements_across);
    CHECK(preview.solver.max_iterations == 20);
    CHECK_FALSE(preview.model.contact);
}
