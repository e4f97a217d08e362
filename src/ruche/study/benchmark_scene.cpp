#include "ruche/study/benchmark_scene.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <stdlib.h>  // mkdtemp

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <system_error>

#include "ruche/core/atomic_file.hpp"
#include "ruche/core/suggest.hpp"
#include "ruche/pattern/generator_registry.hpp"
#include "ruche/pattern/svg_export.hpp"
#include "ruche/scene/build.hpp"

namespace ruche {
namespace {

/// Five strips beside each other, 60 x 1 mm, 5 mm from one centre line to the next.
GeneratedPattern five_strips() {
    constexpr int count = 5;
    constexpr double length_mm = 60.0;
    constexpr double pitch_mm = 5.0;
    GeneratedPattern pattern{.name = "five strips", .description = "60 x 1 mm, pitch 5 mm"};
    for (int i = 0; i < count; ++i) {
        const double y = pitch_mm * i;
        pattern.strips.push_back({.id = fmt::format("strip-{}", i + 1),
                                  .lines = {{.points = {Vec2(0.0, y), Vec2(length_mm, y)}}},
                                  .width = 1.0});
    }
    return pattern;
}

/// Element sizes in proportion to the default ones. On meshes coarser than that, triangles on plastic become
/// longer than a strip is wide.
MeshOptions scaled_mesh(double scale) {
    MeshOptions options;
    options.size_mm *= scale;
    options.fabric_size_mm *= scale;
    options.elements_across = std::clamp(1.0 / scale, 0.5, 1.0);
    return options;
}

int triangles_of(const Scene& scene) { return scene_mesh(scene).mesh.triangle_count(); }

}  // namespace

std::vector<BenchmarkSceneInfo> benchmark_scenes() {
    return {
        {"strips", "five strips 60 x 1 mm, 5 mm apart, 1 mm thick: roll up", 20000},
        {"staggered", "13 rows of staggered strips 12 x 1 mm, 0.8 mm thick: a cylinder", 20000},
        {"torus", "80 radial strips 0.7 mm thick on an annulus: a half torus", 20000},
        {"stars", "12 stars 0.8 mm thick on a disc: a dome that crumples between them", 20000},
        {"svg", "the torus by way of an SVG drawing", 20000},
        {"fivestrips-without-log-terms", "the five strips on fabric whose law has no logarithms (beta = 0)",
         18500},
    };
}

BenchmarkScene::BenchmarkScene(std::string_view name) {
    const auto generated = [&](const char* generator, double thickness_mm) {
        scene_.pattern.generator = generator;
        scene_.plastic.thickness_mm = thickness_mm;
    };
    const auto drawn = [&](const GeneratedPattern& pattern, double thickness_mm) {
        draw(to_svg(pattern));
        scene_.plastic.thickness_mm = thickness_mm;
    };
    if (name == "strips") {
        drawn(five_strips(), 1.0);
    } else if (name == "fivestrips-without-log-terms") {
        drawn(five_strips(), 1.0);
        scene_.material.beta_1 = 0.0;
        scene_.material.beta_2 = 0.0;
    } else if (name == "staggered") {
        generated("staggered", 0.8);
        scene_.fabric.margin_mm = 1.0;
    } else if (name == "torus") {
        generated("radial", 0.7);
    } else if (name == "stars") {
        generated("stars", 0.8);
    } else if (name == "svg") {
        drawn(generate("radial", {}, {}), 0.7);
    } else {
        std::vector<std::string_view> names;
        for (const BenchmarkSceneInfo& known : benchmark_scenes()) names.push_back(known.name);
        throw InputError({.key = "--scene"},
                         fmt::format("there is no scene \"{}\"{}", name, did_you_mean(name, names)),
                         fmt::format("There are {}.", fmt::join(names, ", ")));
    }
}

BenchmarkScene::~BenchmarkScene() {
    std::error_code ignored;
    if (!folder_.empty()) std::filesystem::remove_all(folder_, ignored);
}

void BenchmarkScene::draw(const std::string& svg) {
    folder_ = (std::filesystem::temp_directory_path() / "ruche-bench-XXXXXX").string();
    if (mkdtemp(folder_.data()) == nullptr) {
        const std::error_code reason(errno, std::generic_category());
        folder_.clear();
        throw std::system_error(reason,
                                "cannot make a folder in " + std::filesystem::temp_directory_path().string());
    }
    scene_.pattern.svg = folder_ + "/drawing.svg";
    write_file_atomically(scene_.pattern.svg, svg);
}

void BenchmarkScene::resize(int triangles, const Control& control) {
    constexpr double close = 0.05;
    constexpr double allowed = 0.10;
    constexpr int most_meshes = 12;
    double scale = 1.0;
    double best_scale = 0.0;
    int best = 0;
    const auto error_of = [&](int count) { return std::abs(static_cast<double>(count) / triangles - 1.0); };
    for (int i = 0; i < most_meshes && (best == 0 || error_of(best) > close); ++i) {
        scene_.mesh = scaled_mesh(scale);
        const int count = triangles_of(scene_);
        control.say({"mesh", -1.0, fmt::format("{} triangles with elements of {:.3g} mm", count, scale)});
        if (best == 0 || error_of(count) < error_of(best)) {
            best = count;
            best_scale = scale;
        }
        // Borders hold back coarse meshes: there the count falls more slowly than the square of the size.
        scale *= std::clamp(std::sqrt(static_cast<double>(count) / triangles), 0.05, 4.0);
        if (scale > 50.0) break;
    }
    scene_.mesh = scaled_mesh(best_scale);
    if (error_of(best) > allowed)
        throw InputError({.key = "--triangles"},
                         fmt::format("this scene cannot be meshed with about {} triangles", triangles),
                         fmt::format("The nearest mesh has {}.", best));
}

}  // namespace ruche
