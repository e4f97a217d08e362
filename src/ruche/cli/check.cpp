#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "ruche/cli/scene_arguments.hpp"
#include "ruche/cli/verbs.hpp"
#include "ruche/scene/build.hpp"

namespace ruche {

/// Where a value is from: a place, a material's source, or "default".
static std::string origin(const Scene& scene, const std::string& section, const FieldInfo& about) {
    if (section == "material") {
        const auto source = scene.material_sources.find(std::string(bare_name(about)));
        if (source != scene.material_sources.end()) return source->second;
    }
    const auto place = scene.sources.find(section + "." + std::string(about.key));
    if (place == scene.sources.end()) return "default";
    return to_string(Place{.file = place->second.file, .line = place->second.line});
}

template <class Struct>
static void print_values(const Scene& scene, const std::string& section, const Struct& s) {
    for (const Field<Struct>& field : fields<Struct>()) {
        const FieldInfo about = info(field);
        fmt::print("{:44} {:>14} {:8} {}\n", fmt::format("{}.{}", section, about.key),
                   to_string(get(s, field)), about.unit, origin(scene, section, about));
    }
}

static void print_scene(const Scene& scene) {
    for_each_section(scene, [&](const std::string& name, const auto& section) {
        if (name == "plastic" && scene.plastic.none)
            fmt::print("{:44} {:>14}\n", name, "none");
        else
            print_values(scene, name, section);
    });
    for (const auto& [key, value] : scene.pattern.generator_options)
        fmt::print("{:44} {:>14}\n", "pattern.options." + key, value);
    for (std::size_t i = 0; i < scene.plastic.rules.size(); ++i)
        print_values(scene, fmt::format("plastic.rule.{}", i + 1), scene.plastic.rules[i]);
    for (std::size_t i = 0; i < scene.supports.size(); ++i) {
        print_values<Selection>(scene, fmt::format("support.{}", i + 1), scene.supports[i]);
        print_values(scene, fmt::format("support.{}", i + 1), scene.supports[i]);
    }
    for (std::size_t i = 0; i < scene.forces.size(); ++i) {
        print_values<Selection>(scene, fmt::format("force.{}", i + 1), scene.forces[i]);
        print_values(scene, fmt::format("force.{}", i + 1), scene.forces[i]);
    }
}

static void print_layout(const PrintMesh& layout, const ModelInput& model) {
    Vec2 low = layout.mesh.vertices.front();
    Vec2 high = low;
    for (const Vec2& vertex : layout.mesh.vertices) {
        low = low.cwiseMin(vertex);
        high = high.cwiseMax(vertex);
    }
    double printed = 0.0;
    double whole = 0.0;
    for (int t = 0; t < layout.mesh.triangle_count(); ++t) {
        const double triangle = layout_area(layout.mesh, t);
        whole += triangle;
        if (!layout.print.empty() && !layout.print[static_cast<std::size_t>(t)].bare()) printed += triangle;
    }
    fmt::print("\nlayout     {:.6g} x {:.6g} mm, {:.6g} mm^2, of which {:.6g} mm^2 printed\n",
               high.x() - low.x(), high.y() - low.y(), whole, printed);
    fmt::print("strips     {}\n", layout.strips.size());
    fmt::print("mesh       {} triangles, {} vertices\n", layout.mesh.triangle_count(),
               layout.mesh.vertex_count());
    if (!model.supports.empty()) fmt::print("supports   {} vertices\n", model.supports.size());
}

static void print_list(const std::string& title, const std::vector<std::string>& texts) {
    if (texts.empty()) return;
    fmt::print("\n{}\n", title);
    for (const std::string& text : texts) fmt::print("  {}\n", text);
}

static ExitCode check(const SceneArguments& arguments) {
    const Scene scene = read_scene(arguments);
    const PrintMesh layout = scene_mesh(scene);
    const ModelInput model = scene_model(scene, layout);
    print_scene(scene);
    print_layout(layout, model);
    print_list("assumed:", assumptions(scene, layout));
    std::vector<std::string> warnings = scene.warnings;
    warnings.insert(warnings.end(), layout.warnings.begin(), layout.warnings.end());
    print_list("warnings:", warnings);
    return ExitCode::converged;
}

void add_check(CLI::App& program, Action& action) {
    const auto arguments = std::make_shared<SceneArguments>();
    CLI::App* verb = program.add_subcommand(
        "check", "Read and mesh a scene, and print every value with its source; nothing is simulated");
    add_scene_arguments(*verb, *arguments);
    verb->callback([arguments, &action] { action = [arguments] { return check(*arguments); }; });
}

}  // namespace ruche
