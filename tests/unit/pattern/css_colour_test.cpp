#include <doctest/doctest.h>

#include <string>

#include "ruche/pattern/css_colour.hpp"

using namespace ruche;

TEST_CASE("css colour: every notation of red is red") {
    for (const char* text :
         {"red", "RED", " Red ", "#f00", "#F00", "#ff0000", "#f00f", "#ff0000ff", "rgb(255,0,0)",
          "rgb(255 0 0)", "rgb( 100% , 0% , 0% )", "rgba(255,0,0,1)", "rgb(255 0 0 / 100%)", "rgb(300,-5,0)",
          "hsl(0,100%,50%)", "hsl(360deg 100% 50%)", "hsla(1turn,100%,50%,1)", "#ff0000 icc-color(x, 1)"}) {
        CAPTURE(std::string(text));
        REQUIRE(parse_css_colour(text));
        CHECK(*parse_css_colour(text) == CssColour{255, 0, 0, 1.0});
    }
}

TEST_CASE("css colour: the table of names, its ends and its middle") {
    CHECK(hex_colour(*parse_css_colour("aliceblue")) == "#f0f8ff");
    CHECK(hex_colour(*parse_css_colour("yellowgreen")) == "#9acd32");
    CHECK(hex_colour(*parse_css_colour("RebeccaPurple")) == "#663399");
    CHECK(hex_colour(*parse_css_colour("lightgoldenrodyellow")) == "#fafad2");
}

TEST_CASE("css colour: hsl agrees with the values of CSS Color 4") {
    CHECK(hex_colour(*parse_css_colour("hsl(120, 100%, 25%)")) == "#008000");
    CHECK(hex_colour(*parse_css_colour("hsl(-120 100% 50%)")) == "#0000ff");
    CHECK(hex_colour(*parse_css_colour("hsl(30, 100%, 50%)")) == "#ff8000");
    CHECK(hex_colour(*parse_css_colour("hsl(0, 0%, 100%)")) == "#ffffff");
}

TEST_CASE("css colour: alpha is read from every notation that has it") {
    CHECK(parse_css_colour("transparent")->alpha == 0.0);
    CHECK(parse_css_colour("#0000")->alpha == 0.0);
    CHECK(parse_css_colour("#00000033")->alpha == doctest::Approx(0.2));
    CHECK(parse_css_colour("rgba(1,2,3,.5)")->alpha == 0.5);
    CHECK(parse_css_colour("hsl(0 0% 0% / 25%)")->alpha == 0.25);
}

TEST_CASE("css colour: anything else is none") {
    for (const char* text : {"", "rad", "#", "#ff", "#fffff", "#fffffff", "#ggg", "rgb(1,2)", "rgb(1,2,3",
                             "rgb(a,b,c)", "url(#x)", "none", "rgb", "rgb(1,2,3,4,5)", "#123456789"}) {
        CAPTURE(std::string(text));
        CHECK_FALSE(parse_css_colour(text));
    }
}
