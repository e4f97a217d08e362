#include "ruche/scene/preview.hpp"

#include <algorithm>
#include <cmath>

#include "ruche/geometry/polygon.hpp"
#include "ruche/scene/build.hpp"

namespace ruche {
namespace {

double equilateral_triangles(double covered, double edge) { return covered / (0.433 * edge * edge); }

/// About how many triangles the strips take: no edge is longer than a strip is wide over the elements across.
double triangles_on_strips(const Pattern& pattern, const MeshOptions& mesh) {
    double count = 0.0;
    for (const Strip& strip : pattern.strips) {
        for (const Polygon& polygon : strip.region) {
            const double size = std::min(mesh.size_mm, strip_width(polygon) / mesh.elements_across);
            count += equilateral_triangles(area({polygon}), size);
        }
    }
    return count;
}

MeshOptions preview_mesh(const Pattern& pattern, MeshOptions mesh, double wanted) {
    double printed = 0.0;
    for (const Strip& strip : pattern.strips) printed += area(strip.region);
    const double bare = std::max(0.0, area(pattern.fabric) - printed);
    const double fine =
        equilateral_triangles(printed, mesh.size_mm) + equilateral_triangles(bare, mesh.fabric_size_mm);
    const double factor = std::max(1.0, std::sqrt(fine / wanted));
    mesh.size_mm *= factor;
    mesh.fabric_size_mm *= factor;
    mesh.elements_across = std::min(mesh.elements_across, 1.0);
    // Elements on thin strips cannot be longer than the strips are wide, but for twice: then their angles are
    // those that the mesher keeps to anyway. Around them fabric may coarsen at once.
    if (triangles_on_strips(pattern, mesh) > 0.5 * wanted) {
        mesh.elements_across = 0.5;
        mesh.grading = std::max(mesh.grading, 1.0);
    }
    return mesh;
}

}  // namespace

Scene preview_scene(Scene scene, double triangles) {
    constexpr int patience = 60;  // iterations
    if (scene.pattern.mesh.empty())
        scene.mesh = preview_mesh(scene_pattern(scene), undivided(scene.mesh), triangles);
    scene.solver.max_iterations = std::min(scene.solver.max_iterations, patience);
    scene.model.contact = false;
    return scene;
}

}  // namespace ruche
