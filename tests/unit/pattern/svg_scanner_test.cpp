#include <doctest/doctest.h>

#include <string>

#include "ruche/pattern/svg_scanner.hpp"

using namespace ruche::svg;

TEST_CASE("svg scanner: a number ends where the next one can begin") {
    Scanner scanner("1.5.5-3e1+.25E-2 7em");
    CHECK(scanner.number() == 1.5);
    CHECK(scanner.number() == 0.5);
    CHECK(scanner.number() == -30.0);
    CHECK(scanner.number() == 0.0025);
    scanner.skip_separator();
    CHECK(scanner.number() == 7.0);
    CHECK(scanner.rest() == "em");
}

TEST_CASE("svg scanner: what is no finite number is none") {
    for (const char* text :
         {"", "-", "+", ".", "e5", "nan", "inf", "-inf", "0x10", "1e999", "-1e999", "--1", "+-1", "1 2"}) {
        CAPTURE(std::string(text));
        CHECK_FALSE(parse_number(text));
    }
    CHECK_FALSE(parse_number(std::string(400, '9')));
    CHECK(parse_number("0." + std::string(400, '0') + "1") == 0.0);
    CHECK(parse_number("1e-999") == 0.0);
    CHECK(parse_number(" 5. ") == 5.0);
}

TEST_CASE("svg scanner: lists are numbers with commas or white space, or nothing at all") {
    CHECK(parse_numbers("0,0 100\n-50.5") == std::vector<double>{0.0, 0.0, 100.0, -50.5});
    CHECK(parse_numbers("1 2 x").empty());
    CHECK(parse_fraction("40%") == 0.4);
    CHECK(parse_fraction("0.25") == 0.25);
}

TEST_CASE("svg length: every unit of CSS is what an inch of 96 px makes it") {
    struct Case {
        const char* text;
        double px;
    };
    for (const auto& [text, px] : {Case{"25.4mm", 96.0},
                                   {"2.54cm", 96.0},
                                   {"1in", 96.0},
                                   {"72pt", 96.0},
                                   {"6pc", 96.0},
                                   {"101.6Q", 96.0},
                                   {"96px", 96.0},
                                   {"96", 96.0},
                                   {"6em", 96.0},
                                   {"50%", 100.0},
                                   {" 1IN ", 96.0}}) {
        CAPTURE(std::string(text));
        const auto length = parse_length(text);
        REQUIRE(length);
        CHECK(length->px(200.0) == doctest::Approx(px).epsilon(1e-14));
    }
    CHECK(parse_length("10mm")->physical());
    CHECK_FALSE(parse_length("10px")->physical());
    for (const char* text : {"", "mm", "10 furlongs", "10mmm", "1e5e"}) CHECK_FALSE(parse_length(text));
}
