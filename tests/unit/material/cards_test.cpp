#include "ruche/material/cards.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

using namespace ruche;

namespace {
/// A card file in the tests' working folder, removed at the end.
struct CardFile {
    std::string path;
    CardFile(const std::string& name, const std::string& text) : path("./" + name) {
        std::ofstream(path, std::ios::binary) << text;
    }
    ~CardFile() { std::filesystem::remove(path); }
};

std::string every_value_but(const std::string& left_out, const std::string& source = "measured") {
    std::string text;
    for (const Field<Material>& field : fields<Material>())
        if (field.key != left_out)
            text += std::string(field.key) + " = { value = " + to_string(get(Material{}, field)) +
                    ", source = \"" + source + "\" }\n";
    return text;
}

std::string alpha_1(double value, const std::string& more = "") {
    return "alpha_1_mpa = { value = " + std::to_string(value) + ", source = \"measured\"" + more + " }\n";
}
}  // namespace

TEST_CASE("preset card: holds the defaults of Material, which are Table 1") {
    const ResolvedCard card = resolve_card("spandex-tpu95a", {1.7, 1.7});
    for (const Field<Material>& field : fields<Material>())
        CHECK_MESSAGE(get(card.material, field) == get(Material{}, field), field.key);
    CHECK(card.warnings.empty());
    CHECK(card.sources.at("alpha_1") == "paper Table 1");
    CHECK(card.sources.size() == fields<Material>().size());
}

TEST_CASE("preset card: thickness and both densities are named as assumed") {
    const ResolvedCard card = resolve_card("spandex-tpu95a", {1.7, 1.7});
    const std::vector<std::string> texts = assumed_values(card.material, card.sources);
    REQUIRE(texts.size() == 3);
    CHECK(texts[0].starts_with("fabric_thickness = 0.46 mm (assumed: "));
    CHECK(texts[1].starts_with("fabric_areal_density = 0.2 kg/m^2 (assumed: "));
    CHECK(texts[2].starts_with("plastic_density = 1210 kg/m^3 (assumed: "));
}

TEST_CASE("preset card: the assumed thickness is the one that k_B implies") {
    const Material m;
    const double nu = m.fabric_poissons_ratio;
    const double h = std::cbrt(12 * (1 - nu * nu) * m.fabric_bending_stiffness / m.fabric_youngs_modulus);
    CHECK(m.fabric_thickness == doctest::Approx(h).epsilon(0.01));  // two digits are given
}

TEST_CASE("card with one set: warns away from its pre-stretch, the geometric mean counts") {
    CHECK(resolve_card("spandex-tpu95a", {1.68, 1.7}).warnings.empty());
    CHECK(resolve_card("spandex-tpu95a", {1.445, 2.0}).warnings.empty());
    const ResolvedCard far = resolve_card("spandex-tpu95a", {1.45, 1.45});
    REQUIRE(far.warnings.size() == 1);
    CHECK(far.warnings[0] ==
          "card spandex-tpu95a was calibrated at a pre-stretch of 1.7 only; at 1.45 its values are a guess");
}

TEST_CASE("card with two sets: linear between them, exact at them, the nearest and a warning outside") {
    const CardFile file("two sets.toml", "name = \"two\"\n[common]\n" + every_value_but("alpha_1_mpa") +
                                             "[[set]]\nprestretch = 1.4\n" + alpha_1(0.1) +
                                             "[[set]]\nprestretch = 1.6\n" + alpha_1(0.3));
    const auto alpha_at = [&](double s) { return resolve_card(file.path, {s, s}).material.alpha_1; };
    CHECK(alpha_at(1.4) == 0.1);
    CHECK(alpha_at(1.6) == 0.3);
    CHECK(alpha_at(1.45) == doctest::Approx(0.15).epsilon(1e-12));
    CHECK(alpha_at(1.2) == 0.1);
    CHECK(alpha_at(2.0) == 0.3);
    CHECK(resolve_card(file.path, {1.5, 1.5}).warnings.empty());
    CHECK(resolve_card(file.path, {1.5, 1.5}).sources.at("alpha_1") == "measured (between 0.1 and 0.3)");
    CHECK(resolve_card(file.path, {1.2, 1.2}).warnings.size() == 1);
    CHECK(resolve_card(file.path, {2.0, 2.0}).warnings.size() == 1);
}

TEST_CASE("card file: mistakes are named with file, line and key") {
    struct Case {
        std::string text;
        std::string message;
    };
    const std::string complete = "[[set]]\nprestretch = 1.5\n" + every_value_but("alpha_1_mpa");
    const Case cases[] = {
        {"", "has no [[set]]"},
        {complete, "card.toml:1: set.1: has no alpha_1_mpa"},
        {"[[set]]\n" + every_value_but(""), "card.toml:1: set.1.prestretch: missing"},
        {complete + "alpha_1_mpa = 0.1\n", "expected { value = ..., source"},
        {complete + "alpha_1_mpa = { value = 0.1 }\n", "card.toml:18: set.1.alpha_1_mpa: has no source"},
        {complete + "alpha_1_mpa = { source = \"x\" }\n", "has no value"},
        {complete + alpha_1(-1), "-1 is outside [0, 100000]"},
        {complete + alpha_1(0.1, ", interval = [0.2, 0.3]"), "does not contain the value 0.1"},
        {complete + alpha_1(0.1, ", intervall = [0.2, 0.3]"), "did you mean interval?"},
        {complete + "alpha1_mpa = { value = 1, source = \"x\" }\n", "did you mean alpha_1_mpa?"},
        {complete + alpha_1(0.1) + "[[set]]\nprestretch = 1.4\n" + every_value_but(""), "must increase"},
        {"[[sets]]\n", "card.toml:1: sets: unknown key; did you mean set?"},
    };
    for (const Case& c : cases) {
        const CardFile file("card.toml", c.text);
        CHECK_THROWS_WITH_AS(load_card(file.path), doctest::Contains(c.message.c_str()), InputError);
    }
    const CardFile good("card.toml", complete + alpha_1(0.1, ", interval = [0.05, 0.3]"));
    CHECK(load_card(good.path).sets.at(0).values.at("alpha_1").interval.has_value());
    const CardFile texts("card.toml", complete + alpha_1(0.1, ", files = [1]"));
    CHECK_THROWS_WITH_AS(load_card(texts.path), doctest::Contains("expected a list of texts in quotes"),
                         InputError);
}

TEST_CASE("card: files of a value are kept, and its warnings go with every material made from it") {
    const CardFile file("card.toml",
                        "name = \"knit\"\nwarnings = [\"E_f is odd\"]\n[[set]]\nprestretch = 1.5\n" +
                            every_value_but("alpha_1_mpa") + alpha_1(0.1, ", files = [\"a.csv sha256:00\"]"));
    CHECK(load_card(file.path).sets.at(0).values.at("alpha_1").files ==
          std::vector<std::string>{"a.csv sha256:00"});
    CHECK(resolve_card(file.path, {1.5, 1.5}).warnings == std::vector<std::string>{"card knit: E_f is odd"});
}

TEST_CASE("card: an unknown name suggests the nearest") {
    CHECK_THROWS_WITH_AS(load_card("spandex-tpu95"), doctest::Contains("did you mean spandex-tpu95a?"),
                         InputError);
    CHECK_THROWS_WITH_AS(load_card("none.toml"), doctest::Contains("there is no such file"), InputError);
}

TEST_CASE("check_prestretch: ends where the fabric locks, axis by axis") {
    const Material material;
    CHECK_NOTHROW(check_prestretch(material, {1.71, 1.71}, {}));
    CHECK_NOTHROW(check_prestretch(material, {1.7102, 1.7108}, {}));
    CHECK_THROWS_WITH_AS(
        check_prestretch(material, {1.7104, 1.7}, {}),
        doctest::Contains("1.7104 is beyond the fabric's law, which ends at 1.7103 along its first axis"),
        InputError);
    CHECK_THROWS_WITH_AS(check_prestretch(material, {1.7, 1.72}, {}), doctest::Contains("second axis"),
                         InputError);
}
