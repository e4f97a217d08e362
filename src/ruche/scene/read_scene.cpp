#include "ruche/scene/read_scene.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "ruche/core/table_reader.hpp"
#include "ruche/material/cards.hpp"
#include "ruche/scene/check_scene.hpp"

namespace ruche {

static std::string option_text(const Node& node, const std::string& path) {
    switch (node.kind) {
        case Node::Kind::boolean:
            return to_string(FieldValue(node.boolean));
        case Node::Kind::integer:
            return fmt::format("{}", node.integer);
        case Node::Kind::number:
            return to_string(FieldValue(node.number));
        case Node::Kind::text:
            return node.text;
        default:
            throw InputError(place_of(node, path),
                             "expected a number, a text, true or false, found " + describe(node));
    }
}

static void read_pattern(TableReader& reader, Scene& scene) {
    reader.read(scene.pattern);
    const Node* options = reader.take_table("options");
    if (options == nullptr) return;
    const std::string path = reader.path_of("options");
    for (const Node& item : options->items) {
        const std::string key = path + "." + item.key;
        scene.pattern.generator_options[item.key] = option_text(item, key);
        scene.sources[key] = place_of(item, key);
    }
}

static void read_plastic(TableReader& reader, Scene& scene) {
    PlasticOptions& plastic = scene.plastic;
    reader.read(plastic);
    for (const Node* node : reader.take_tables("rule")) {
        TableReader rule(*node, fmt::format("{}.{}", reader.path_of("rule"), plastic.rules.size() + 1),
                         &scene.sources);
        plastic.rules.push_back({.thickness = plastic.thickness_mm, .side = plastic.side});
        rule.read(plastic.rules.back());
        rule.finish();
        if (plastic.rules.back().match.empty())
            throw InputError(rule.place_of_key("match"), "missing",
                             "Which shapes is this rule for? A colour, layer, class, id or label.");
    }
}

/// The card's values, then those of the scene; [material.source] may say where the latter are from.
static void read_material(TableReader& reader, Scene& scene) {
    reader.read(scene.material);
    const Node no_sources;
    const Node* node = reader.take_table("source");
    TableReader given(node != nullptr ? *node : no_sources, reader.path_of("source"));
    for (const Field<Material>& field : fields<Material>()) {
        const std::string name(bare_name(info(field)));
        const Node* source = given.take(name);
        const auto place = scene.sources.find(reader.path_of(field.key));
        if (source != nullptr && source->kind != Node::Kind::text)
            throw InputError(given.place_of_key(name),
                             "expected a text in quotes, found " + describe(*source));
        if (source != nullptr && place == scene.sources.end())
            throw InputError(given.place_of_key(name),
                             fmt::format("there is no {} in this scene", field.key));
        if (source != nullptr)
            scene.material_sources[name] = source->text;
        else if (place != scene.sources.end())
            scene.material_sources[name] =
                to_string(Place{.file = place->second.file, .line = place->second.line});
    }
    given.finish();
}

static bool gives_every_value(const Node* material) {
    if (material == nullptr) return false;
    for (const Field<Material>& field : fields<Material>())
        if (material->find(field.key) == nullptr) return false;
    return true;
}

/// A scene that gives every value itself (the record of an earlier run) does not need its card file.
static void take_card(Scene& scene, const Node* material) {
    const std::string& card = scene.fabric.card;
    const bool is_file = is_card_path(card);
    const std::string path = is_file ? resolved_path(scene, card) : card;
    std::error_code ignored;
    if (is_file && gives_every_value(material) && !std::filesystem::exists(path, ignored)) return;
    const ResolvedCard resolved = [&] {
        try {
            return resolve_card(path, scene.fabric.prestretch);
        } catch (const InputError& error) {
            if (!error.place().file.empty()) throw;
            throw InputError(place_in(scene, "fabric.card"), error.problem(), error.advice());
        }
    }();
    scene.material = resolved.material;
    scene.material_sources = resolved.sources;
    scene.warnings.insert(scene.warnings.end(), resolved.warnings.begin(), resolved.warnings.end());
}

static void read_selection(TableReader& reader, Selection& selection) {
    reader.read(selection);
    const bool box = reader.has("min_mm") || reader.has("max_mm");
    const bool point = reader.has("point_mm");
    if (reader.has("where")) return;
    if (box && point)
        throw InputError(reader.place_of_key("point_mm"), "contradicts the box of min_mm and max_mm",
                         "Give one of them, or two entries.");
    if (!point && !(reader.has("min_mm") && reader.has("max_mm")))
        throw InputError(
            reader.place_of_key(reader.has("min_mm") ? "max_mm" : "min_mm"), "missing",
            "Which vertices are held? Those in a box, min_mm and max_mm, or the one at point_mm.");
    selection.where = point ? Selection::Where::point : Selection::Where::box;
}

template <class Options>
static void read_selections(TableReader& root, std::string_view key, Scene& scene,
                            std::vector<Options>& all) {
    for (const Node* node : root.take_tables(key)) {
        TableReader reader(*node, fmt::format("{}.{}", key, all.size() + 1), &scene.sources);
        Options options;
        read_selection(reader, options);
        reader.read(options);
        reader.finish();
        const std::string path = fmt::format("{}.{}", key, all.size() + 1);
        scene.sources.emplace(path, place_of(*node, path));  // for what is found when the mesh is known
        all.push_back(options);
    }
}

static void read_sections(const Node& root, Scene& scene) {
    TableReader reader(root, "", &scene.sources);
    const Node* plastic = reader.take("plastic");
    if (plastic != nullptr && plastic->kind == Node::Kind::text && plastic->text == "none")
        scene.plastic.none = true;
    else if (plastic != nullptr && plastic->kind == Node::Kind::text)
        throw InputError(place_of(*plastic, "plastic"),
                         fmt::format("expected [plastic] or \"none\", found {}", describe(*plastic)));
    const Node* material = reader.take_table("material");
    for_each_section(scene, [&]<class Section>(const std::string& name, Section& section) {
        if (name == "plastic" && scene.plastic.none) return;
        if constexpr (std::is_same_v<Section, Material>) take_card(scene, material);
        const Node* node = reader.take_table(name);
        if (node == nullptr) return;
        TableReader table(*node, name, &scene.sources);
        if constexpr (std::is_same_v<Section, PatternSource>)
            read_pattern(table, scene);
        else if constexpr (std::is_same_v<Section, PlasticOptions>)
            read_plastic(table, scene);
        else if constexpr (std::is_same_v<Section, Material>)
            read_material(table, scene);
        else
            table.read(section);
        table.finish();
    });
    read_selections(reader, "support", scene, scene.supports);
    read_selections(reader, "force", scene, scene.forces);
    reader.finish();
}

static Scene scene_from_tree(Node root, const std::string& file, const std::vector<Override>& overrides) {
    apply_overrides(root, overrides);
    Scene scene;
    scene.file = file;
    read_sections(root, scene);
    check_scene(scene);
    return scene;
}

Scene read_scene(const std::string& path, const std::vector<Override>& overrides) {
    Node root = read_toml(path);
    if (root.items.empty())
        throw InputError(
            {.file = path}, "is empty, expected a scene",
            "The shortest scene is: [pattern] svg = \"my.svg\"; `ruche check --example` shows every key.");
    return scene_from_tree(std::move(root), path, overrides);
}

Scene parse_scene(const std::string& text, const std::string& file, const std::vector<Override>& overrides) {
    return scene_from_tree(parse_toml(text, file), file, overrides);
}

static std::string ending(const std::string& path) {
    std::string text = std::filesystem::path(path).extension().string();
    for (char& c : text)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return text;
}

Scene scene_from_drawing(const std::string& path, const std::vector<Override>& overrides) {
    const std::string key = ending(path) == ".ply" || ending(path) == ".obj" ? "mesh" : "svg";
    std::vector<Override> all = {{.path = "pattern." + key, .value = toml_quoted(path), .option = path}};
    all.insert(all.end(), overrides.begin(), overrides.end());
    return scene_from_tree(Node{}, "", all);
}

Scene read_scene_or_drawing(const std::string& path, const std::vector<Override>& overrides) {
    const std::string kind = ending(path);
    if (kind == ".toml") return read_scene(path, overrides);
    if (kind == ".svg" || kind == ".ply" || kind == ".obj") return scene_from_drawing(path, overrides);
    std::error_code ignored;
    if (!std::filesystem::exists(path, ignored)) throw InputError({.file = path}, "there is no such file");
    throw InputError({.file = path}, "is neither a scene (.toml), a drawing (.svg) nor a mesh (.ply, .obj)",
                     kind == ".dxf" ? "DXF cannot be read yet; save the drawing as SVG." : "");
}

}  // namespace ruche
