#include "ruche/core/document.hpp"

#include <doctest/doctest.h>

#include <string>

using namespace ruche;

TEST_CASE("parse_toml: every value knows its line") {
    const Node root = parse_toml("a = 1\n\n[table]\nb = [1.5, 2]\nc = \"x\"\n", "kite.toml");
    REQUIRE(root.find("table") != nullptr);
    const Node* b = root.find("table")->find("b");
    REQUIRE(b != nullptr);
    CHECK(b->line == 4);
    CHECK(to_string(place_of(*b, "table.b")) == "kite.toml:4: table.b");
    CHECK(b->items.size() == 2);
    CHECK(b->items[0].number == 1.5);
    CHECK(b->items[1].integer == 2);
    CHECK(root.find("table")->find("c")->text == "x");
}

TEST_CASE("parse_toml: mistakes are named with their line") {
    CHECK_THROWS_WITH_AS(parse_toml("a = 1\nb = = 2\n", "kite.toml"),
                         doctest::Contains("kite.toml:2: not valid TOML"), InputError);
    CHECK_THROWS_WITH_AS(parse_toml("a = 1\na = 2\n", "k"), doctest::Contains("k:2"), InputError);
    CHECK_THROWS_WITH_AS(parse_toml("\xFF\xFE a", "k"), doctest::Contains("UTF-16"), InputError);
    CHECK_THROWS_WITH_AS(parse_toml("a = \"\n\xE4\"", "k"), doctest::Contains("k:2: byte 0xE4"), InputError);
    CHECK_THROWS_WITH_AS(parse_toml(std::string("a = 1\n\0", 7), "k"), doctest::Contains("binary"),
                         InputError);
}

TEST_CASE("parse_toml: absurd nesting ends in a message") {
    const int deep = 100000;
    std::string dotted = "a";
    std::string header = "[a";
    for (int i = 0; i < deep; ++i) dotted += ".a";
    for (int i = 0; i < deep; ++i) header += ".a";
    CHECK_THROWS_AS(parse_toml(dotted + " = 1", "k"), InputError);
    CHECK_THROWS_AS(parse_toml(header + "]", "k"), InputError);
    CHECK_THROWS_AS(parse_toml("a = " + std::string(deep, '['), "k"), InputError);
    std::string inlined = "a = ";
    for (int i = 0; i < deep; ++i) inlined += "{a=";
    CHECK_THROWS_AS(parse_toml(inlined, "k"), InputError);
    std::string growing;  // [a] [a.a] [a.a.a] ...: each header one part longer
    std::string name = "a";
    for (int i = 0; i < 120; ++i, name += ".a") growing += "[" + name + "]\n";
    CHECK_THROWS_AS(parse_toml(growing, "k"), InputError);
}

TEST_CASE("parse_toml: umlauts and four-byte characters are text") {
    const Node root = parse_toml("a = \"M\xC3\xBCnchen \xF0\x9F\xAA\x81\"", "k");
    CHECK(root.find("a")->text == "M\xC3\xBCnchen \xF0\x9F\xAA\x81");
}

TEST_CASE("toml_quoted: any text comes back") {
    const std::string text = "a\"b\\c\n\t\x7F\x01 \xC3\xBC";
    CHECK(parse_toml("a = " + toml_quoted(text), "k").find("a")->text == text);
}

TEST_CASE("read_file: missing files and folders are told apart") {
    CHECK_THROWS_WITH_AS(read_file("no-such.toml", "scene", 10), doctest::Contains("there is no such file"),
                         InputError);
    CHECK_THROWS_WITH_AS(read_file(".", "scene", 10), doctest::Contains("is a folder"), InputError);
}
