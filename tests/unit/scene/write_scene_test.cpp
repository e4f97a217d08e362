#include "ruche/scene/write_scene.hpp"

#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "ruche/core/document.hpp"
#include "ruche/scene/read_scene.hpp"

using namespace ruche;

namespace {
/// Another admissible value of the field.
FieldValue changed(const FieldInfo& about, FieldValue value) {
    const double low = about.low;
    const double high = about.high;
    const auto other = [&](double number) {
        return number + 0.3 * ((number < 0.5 * (low + high) ? high : low) - number);
    };
    if (auto* number = std::get_if<double>(&value)) *number = other(*number);
    if (auto* integer = std::get_if<int>(&value)) *integer = static_cast<int>(other(*integer));
    if (auto* flag = std::get_if<bool>(&value)) *flag = !*flag;
    if (auto* pair = std::get_if<std::array<double, 2>>(&value))
        *pair = {other((*pair)[0]), other((*pair)[1]) + 1e-7};
    if (auto* triple = std::get_if<std::array<double, 3>>(&value))
        *triple = {other((*triple)[0]), 0.1, other((*triple)[2])};
    if (auto* text = std::get_if<std::string>(&value))
        *text = about.kind == FieldKind::choice ? std::string(about.names.back()) : *text + "\"M\xC3\xBC\\";
    return value;
}

template <class Struct>
void change(Struct& s) {
    for (const Field<Struct>& field : fields<Struct>()) set(s, field, changed(info(field), get(s, field)));
}

template <class Struct>
void check_same(const Struct& a, const Struct& b) {
    for (const Field<Struct>& field : fields<Struct>())
        CHECK_MESSAGE(get(a, field) == get(b, field), field.key);
}

void check_same_scene(const Scene& a, const Scene& b) {
    for_each_section(a, [&]<class Section>(const std::string& name, const Section& section) {
        for_each_section(b, [&]<class Other>(const std::string& other_name, const Other& other) {
            if constexpr (std::is_same_v<Section, Other>)
                if (name == other_name) check_same(section, other);
        });
    });
    CHECK(a.pattern.generator_options == b.pattern.generator_options);
    CHECK(a.material_sources == b.material_sources);
    CHECK(a.plastic.none == b.plastic.none);
    REQUIRE(a.plastic.rules.size() == b.plastic.rules.size());
    for (std::size_t i = 0; i < a.plastic.rules.size(); ++i)
        check_same(a.plastic.rules[i], b.plastic.rules[i]);
    REQUIRE(a.supports.size() == b.supports.size());
    for (std::size_t i = 0; i < a.supports.size(); ++i) {
        check_same<Selection>(a.supports[i], b.supports[i]);
        check_same(a.supports[i], b.supports[i]);
    }
    REQUIRE(a.forces.size() == b.forces.size());
    for (std::size_t i = 0; i < a.forces.size(); ++i) {
        check_same<Selection>(a.forces[i], b.forces[i]);
        check_same(a.forces[i], b.forces[i]);
    }
}

/// A valid scene in which nothing has its default.
Scene unusual_scene() {
    Scene scene;
    for_each_section(scene, [](const std::string&, auto& section) { change(section); });
    scene.pattern = {.svg = "M\xC3\xBCnchen \"x\".svg", .width_mm = 33.3, .flatten_tolerance_mm = 0.0123};
    scene.fabric.card = "spandex-tpu95a";
    scene.plastic.rules.push_back({});
    change(scene.plastic.rules[0]);
    scene.plastic.rules.push_back({.match = "b", .side = Side::front});
    scene.supports.push_back({});
    change(scene.supports[0]);
    scene.supports[0].fix = "xyz";
    scene.supports[0].where = Selection::Where::point;
    scene.forces.push_back({});
    scene.forces[0].force_n = {0.1, 1.0 / 3.0, 0};
    scene.forces[0].max_mm = {3, 4};
    for (const Field<Material>& field : fields<Material>())
        scene.material_sources[std::string(bare_name(info(field)))] = "measured \"here\"";
    return scene;
}

std::string file_text(const std::string& path) {
    std::ostringstream text;
    text << std::ifstream(path, std::ios::binary).rdbuf();
    return text.str();
}
const std::string docs = RUCHE_TEST_DATA "/../../docs/";
}  // namespace

TEST_CASE("to_toml: the scene that is read again is the same, defaults or not") {
    const Scene plain = parse_scene("pattern.svg = \"a.svg\"", "k.toml");
    check_same_scene(plain, parse_scene(to_toml(plain), "k.toml"));
    const Scene unusual = unusual_scene();
    check_same_scene(unusual, parse_scene(to_toml(unusual), "k.toml"));
    CHECK(to_toml(parse_scene(to_toml(unusual), "k.toml")) == to_toml(unusual));
}

TEST_CASE("to_toml: generators with options and bare fabric come back") {
    const Scene scene = parse_scene(
        "plastic = \"none\"\n[pattern]\ngenerator = \"radial\"\n[pattern.options]\ninner_mm = 12.5\n\"odd "
        "key\" = true",
        "k.toml");
    CHECK(scene.pattern.generator_options.at("inner_mm") == "12.5");
    check_same_scene(scene, parse_scene(to_toml(scene), "k.toml"));
}

TEST_CASE("to_toml: paths lead to the same files from another folder") {
    const Scene scene = parse_scene("pattern.svg = \"../c/a.svg\"", "a/b/k.toml");
    const Scene moved = parse_scene(to_toml(scene, "results/x"), "results/x/scene.toml");
    CHECK(std::filesystem::weakly_canonical(resolved_path(moved, moved.pattern.svg)) ==
          std::filesystem::weakly_canonical("a/c/a.svg"));
}

TEST_CASE("to_toml: a generator's file is the same from another folder, and none stays none") {
    const std::string pattern = "[pattern]\ngenerator = \"traced\"\n[pattern.options]\nfile = ";
    const Scene scene = parse_scene(pattern + "\"../c/field.csv\"", "a/b/k.toml");
    const Scene moved = parse_scene(to_toml(scene, "results/x"), "results/x/scene.toml");
    CHECK(std::filesystem::weakly_canonical(resolved_generator_options(moved).at("file")) ==
          std::filesystem::weakly_canonical("a/c/field.csv"));
    CHECK(pattern_files(scene) == std::vector<std::string>{"../c/field.csv"});
    const Scene without = parse_scene(pattern + "\"\"", "a/b/k.toml");
    CHECK(resolved_generator_options(without).at("file").empty());
    CHECK(pattern_files(without).empty());
}

TEST_CASE("scene template: reads as a scene in which everything has its default") {
    const Scene from_template = parse_scene(scene_template(), "k.toml");
    Scene plain = parse_scene("pattern.svg = \"drawing.svg\"", "k.toml");
    plain.material_sources = from_template.material_sources;
    check_same_scene(plain, from_template);
}

TEST_CASE("docs: the committed scene reference is the generated one") {
    CHECK(file_text(docs + "scene-reference.toml") == scene_template());
    CHECK(file_text(docs + "scene.md") == scene_manual());
}
