#include <doctest/doctest.h>

#include <string>

#include "svg_text.hpp"

using namespace ruche;

static std::string rectangle(const std::string& attributes) {
    return "<rect id='r' width='10' height='10' " + attributes + "/>";
}

static std::string fill_of(const std::string& body) {
    const Drawing drawing = svg_text::draw(body);
    return drawing.shapes.empty() ? "" : drawing.shapes.back().fill_colour;
}

TEST_CASE("svg style: attribute, sheet, style attribute and !important win in this order") {
    CHECK(fill_of(rectangle("fill='#000001'")) == "#000001");
    CHECK(fill_of("<style>rect{fill:#000002}</style>" + rectangle("fill='#000001'")) == "#000002");
    CHECK(fill_of("<style>rect{fill:#000002}</style>" + rectangle("style='fill:#000003' fill='#000001'")) ==
          "#000003");
    CHECK(fill_of("<style>rect{fill:#000002 !important}</style>" + rectangle("style='fill:#000003'")) ==
          "#000002");
    CHECK(fill_of("<style>rect{fill:#000002!important}</style>" +
                  rectangle("style='fill:#000003 ! important'")) == "#000003");
}

TEST_CASE("svg style: the more specific selector wins, then the later one") {
    const std::string target = rectangle("class='cls-1 b'");
    CHECK(fill_of("<style>.cls-1{fill:#000001} rect{fill:#000002}</style>" + target) == "#000001");
    CHECK(fill_of("<style>.cls-1{fill:#000001} .b{fill:#000002}</style>" + target) == "#000002");
    CHECK(fill_of("<style>.b.cls-1{fill:#000001} .b{fill:#000002}</style>" + target) == "#000001");
    CHECK(fill_of("<style>#r{fill:#000001} rect.b.cls-1{fill:#000002}</style>" + target) == "#000001");
    CHECK(fill_of("<style>*{fill:#000001} </style>" + target) == "#000001");
    CHECK(fill_of("<style>rect.b{fill:#000001} .b{fill:#000002}</style>" + target) == "#000001");
    CHECK(fill_of("<style>path.b{fill:#000001} .b{fill:#000002}</style>" + target) == "#000002");
    CHECK(fill_of("<style>rect[width='10']{fill:#000001} .x{fill:#000002}</style>" + target) == "#000001");
    CHECK(fill_of("<style>rect[height]{fill:#000001}</style>" + target) == "#000001");
}

TEST_CASE("svg style: lists, descendants and children select") {
    const std::string target =
        "<g class='outer'><g id='mid'><g class='inner'>" + rectangle("class='b'") + "</g></g></g>";
    CHECK(fill_of("<style>.q, .b ,#z{fill:#000001}</style>" + target) == "#000001");
    CHECK(fill_of("<style>.outer rect{fill:#000001}</style>" + target) == "#000001");
    CHECK(fill_of("<style>.outer > rect{fill:#000001}</style>" + target) == "#000000");
    CHECK(fill_of("<style>.inner>rect{fill:#000001}</style>" + target) == "#000001");
    CHECK(fill_of("<style>svg .outer #mid>.inner .b{fill:#000001}</style>" + target) == "#000001");
    CHECK(fill_of("<style>#mid .outer .b{fill:#000001}</style>" + target) == "#000000");
}

TEST_CASE("svg style: comments, CDATA, several sheets and foreign rules do not disturb") {
    CHECK(fill_of("<style><![CDATA[ /* a { */ @font-face{font-family:'x';src:url(data:font;base64,AA==)} "
                  ".b{fill:/**/#000001;} ]]></style><style type='text/css'>.c{stroke:red}</style>" +
                  rectangle("class='b c'")) == "#000001");
    CHECK(fill_of("<style type='text/less'>.b{fill:#000001}</style>" + rectangle("class='b'")) == "#000000");
    const Drawing drawing = svg_text::draw(
        "<style>@import url(x.css);\n.b:hover{fill:red} .b{fill:#000001}"
        "@media print{.b{fill:#000002}}</style>" +
        rectangle("class='b'"));
    CHECK(drawing.shapes.at(0).fill_colour == "#000001");
    CHECK(svg_text::warns(drawing, "style: style sheet: '@import url(x.css)' is not understood"));
    CHECK(svg_text::warns(drawing, "selector '.b:hover'"));
    CHECK(svg_text::warns(drawing, "'@media print'"));
}

TEST_CASE("svg style: inherited properties are inherited, others are not") {
    const Drawing drawing = svg_text::draw(
        "<g fill='none' stroke='currentColor' color='#010203' stroke-width='2' opacity='0.5' "
        "vector-effect='non-scaling-stroke'><path d='M0 50h50'/>"
        "<path d='M0 60h50' color='#040506' stroke-width='inherit'/></g>");
    REQUIRE(drawing.shapes.size() == 2);
    CHECK(drawing.shapes[0].stroke_colour == "#010203");
    CHECK(drawing.shapes[1].stroke_colour == "#040506");
    CHECK(drawing.shapes[0].stroke_width == doctest::Approx(2.0));
    CHECK(drawing.shapes[1].stroke_width == doctest::Approx(2.0));
    CHECK(fill_of("<g fill='#000001'>" + rectangle("fill='initial'") + "</g>") == "#000000");
    CHECK(fill_of("<g fill='#000001'>" + rectangle("fill='inherit'") + "</g>") == "#000001");
}

TEST_CASE("svg style: what nobody sees is not printed") {
    for (const char* attributes :
         {"fill='none'", "opacity='0'", "fill-opacity='0%'", "fill='transparent'", "fill='rgba(0,0,0,0)'",
          "display='none'", "visibility='hidden'", "style='display:none'", "style='visibility:collapse'",
          "fill='none' stroke='red' stroke-width='0'", "fill='none' stroke='red' stroke-opacity='0'",
          "transform='scale(0)'", "fill='none' stroke='red' transform='scale(1 0)'"}) {
        CAPTURE(std::string(attributes));
        const Drawing drawing = svg_text::draw(rectangle(attributes));
        CHECK(drawing.shapes.empty());
        REQUIRE(drawing.warnings.size() == 1);
        CHECK(drawing.warnings[0].find("drawing.svg:2: rect 'r': ") != std::string::npos);
        CHECK(drawing.warnings[0].find("not printed") != std::string::npos);
    }
    CHECK(svg_text::draw("<g opacity='0'>" + rectangle("opacity='1'") + "</g>").shapes.empty());
    CHECK(svg_text::draw("<g display='none'>" + rectangle("display='inline'") + "</g>").shapes.empty());
    CHECK(svg_text::draw("<g visibility='hidden'>" + rectangle("visibility='visible'") + "</g>")
              .shapes.size() == 1);
    CHECK(svg_text::draw(rectangle("fill-opacity='0.01'")).shapes.size() == 1);
}

TEST_CASE("svg style: a value that cannot be read is ignored with a warning") {
    const Drawing drawing = svg_text::draw(
        "<g stroke='red' stroke-width='2'><path id='p' d='M0 50h50' stroke-width='-3' "
        "stroke-linecap='pointy' "
        "fill='rad' stroke-dasharray='1 x' transform='rotte(3)'/></g>");
    CHECK(drawing.shapes.at(0).stroke_width == doctest::Approx(2.0));
    for (const char* text : {"stroke-width: '-3'", "stroke-linecap: 'pointy'", "fill: 'rad'",
                             "stroke-dasharray: '1 x'", "transform: 'rotte(3)'"}) {
        CAPTURE(std::string(text));
        CHECK(svg_text::warns(drawing, text));
    }
}

TEST_CASE("svg style: a gradient of one colour is that colour, others are not printed") {
    const std::string defs =
        "<defs><linearGradient id='swatch'><stop style='stop-color:#123456'/></linearGradient>"
        "<linearGradient id='used' xlink:href='#swatch'/>"
        "<linearGradient id='blend'><stop stop-color='red'/><stop offset='1' stop-color='blue'/>"
        "</linearGradient><pattern id='dots'/></defs>";
    CHECK(fill_of(defs + rectangle("fill='url(#swatch)'")) == "#123456");
    CHECK(fill_of(defs + rectangle("style=\"fill:url('#used')\"")) == "#123456");
    CHECK(fill_of(defs + rectangle("fill='url(#missing) #00ff00'")) == "#00ff00");
    for (const char* paint : {"url(#blend)", "url(#dots)", "url(#missing)", "url(#dots) red"}) {
        CAPTURE(std::string(paint));
        const Drawing drawing = svg_text::draw(defs + rectangle("fill='" + std::string(paint) + "'"));
        CHECK(drawing.shapes.empty());
        CHECK(svg_text::warns(drawing, "rect 'r': the fill is no plain colour"));
    }
}

TEST_CASE("svg style: Illustrator's entities stand for whole style attributes") {
    const Drawing drawing = svg_text::read(
        "<!DOCTYPE svg PUBLIC \"-//W3C//DTD SVG 1.1//EN\" \"svg11.dtd\" [\n"
        "  <!ENTITY ns_svg \"http://www.w3.org/2000/svg\">\n"
        "  <!ENTITY st0 \"fill:none;stroke:#ED1C24;stroke-width:2;\">\n]>\n"
        "<svg xmlns=\"&ns_svg;\" width='100mm' height='100mm' viewBox='0 0 100 100'>"
        "<path style=\"&st0;stroke-linecap:round\" d='M10 10h50'/></svg>");
    CHECK(drawing.shapes.at(0).stroke_colour == "#ed1c24");
    CHECK(drawing.shapes.at(0).stroke_width == doctest::Approx(2.0));
    CHECK(area(drawing.shapes.at(0).stroked) > 102.9);
    CHECK(drawing.warnings.empty());
}
