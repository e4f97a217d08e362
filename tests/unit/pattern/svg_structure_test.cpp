#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "svg_text.hpp"

using namespace ruche;
using svg_text::extent;

using svg_text::ids;
using Ids = std::vector<std::string>;

TEST_CASE("svg structure: nested transforms multiply from the outside in") {
    const Drawing drawing = svg_text::draw(
        "<g transform='translate(50 50)'><g transform='scale(2)'>"
        "<rect width='5' height='10' transform='rotate(90)'/></g></g>");
    const auto box = extent(drawing.shapes.at(0).filled);
    CHECK(box.left == 30.0);
    CHECK(box.right == 50.0);
    CHECK(box.high == 50.0);
    CHECK(box.low == 40.0);
}

TEST_CASE("svg structure: an id, else a label, else the order names a shape uniquely") {
    const Drawing drawing = svg_text::draw(
        "<rect id='a' width='5' height='5'/><rect inkscape:label='arm left' width='5' height='5'/>"
        "<rect width='5' height='5'/><circle r='2'/><rect id='a' width='5' height='5'/>"
        "<rect id='a-2' width='5' height='5'/><rect id='a' inkscape:label='third' width='5' height='5'/>");
    CHECK(ids(drawing) == Ids{"a", "arm left", "rect-3", "circle-4", "a-2", "a-2-2", "a-3"});
    CHECK(drawing.shapes[6].label == "third");
}

TEST_CASE("svg structure: Inkscape's layers are layers, groups in them are not") {
    const Drawing drawing = svg_text::draw(
        "<g id='layer1' inkscape:groupmode='layer' inkscape:label='Front'><g id='g12'><rect width='5' "
        "height='5'/></g>"
        "<g id='layer2' inkscape:groupmode='layer' inkscape:label='Sub'><rect width='5' height='5'/></g></g>"
        "<g id='Back_side' data-name='Back side'><g><rect width='5' height='5'/></g></g>"
        "<g id='Default'><rect class='cls-1 wide' width='5' height='5'/></g><rect width='5' height='5'/>");
    REQUIRE(drawing.shapes.size() == 5);
    CHECK(drawing.shapes[0].layer == "Front");
    CHECK(drawing.shapes[0].groups == Ids{"g12", "Front", "layer1"});
    CHECK(drawing.shapes[1].layer == "Sub");
    CHECK(drawing.shapes[1].groups == Ids{"Sub", "layer2", "Front", "layer1"});
    CHECK(drawing.shapes[2].layer == "Back side");
    CHECK(drawing.shapes[3].layer == "Default");
    CHECK(drawing.shapes[3].classes == Ids{"cls-1", "wide"});
    CHECK(drawing.shapes[4].layer.empty());
}

TEST_CASE("svg structure: Illustrator's single layer is the svg element itself") {
    const Drawing drawing = svg_text::read(
        "<svg id='Ebene_1' data-name='Ebene 1' viewBox='0 0 10 10'><rect width='5' height='5'/></svg>");
    CHECK(drawing.shapes.at(0).layer == "Ebene 1");
}

TEST_CASE("svg structure: use draws what it refers to, where it says, with its own style") {
    const Drawing drawing = svg_text::draw(
        "<defs><rect id='r' width='10' height='10'/><g id='pair'><rect id='left' width='1' height='1'/>"
        "<circle cx='5' cy='5' r='1'/></g></defs>"
        "<g id='Front'><use id='u1' href='#r' x='20' y='30' fill='#112233'/>"
        "<use xlink:href='#r' transform='translate(60 60) scale(2)'/>"
        "<use id='u2' inkscape:label='pair of things' href=' #pair '/><use href='#u1' x='1'/></g>");
    CHECK(ids(drawing) == Ids{"u1", "r", "u2/left", "u2/circle-4", "u1-2"});
    CHECK(drawing.shapes[0].fill_colour == "#112233");
    const auto box = extent(drawing.shapes[0].filled);
    CHECK(box.left == 20.0);
    CHECK(box.high == 70.0);
    CHECK(area(drawing.shapes[1].filled) == doctest::Approx(400.0));
    CHECK(extent(drawing.shapes[4].filled).left == 21.0);
    for (const Shape& shape : drawing.shapes) CHECK(shape.layer == "Front");
}

TEST_CASE("svg structure: a sheet matches a clone's original, not the place of the clone") {
    const Drawing drawing = svg_text::draw(
        "<style>.defs rect{fill:#000001} .here rect{fill:#000002}</style>"
        "<defs class='defs'><g id='g'><rect width='5' height='5'/></g></defs><g class='here'><use "
        "href='#g'/></g>");
    CHECK(drawing.shapes.at(0).fill_colour == "#000001");
}

TEST_CASE("svg structure: symbols and nested svg elements have viewports") {
    const Drawing drawing = svg_text::draw(
        "<symbol id='s' viewBox='0 0 10 10' preserveAspectRatio='none'><rect width='10' "
        "height='10'/></symbol>"
        "<use href='#s' x='10' y='20' width='30' height='40'/>"
        "<svg x='50' y='50' width='20' height='40' viewBox='0 0 10 10'><rect width='100%' "
        "height='100%'/></svg>"
        "<svg x='50%' y='0' width='20' height='40'><rect width='50%' height='50%'/></svg>");
    REQUIRE(drawing.shapes.size() == 3);
    const auto symbol = extent(drawing.shapes[0].filled);
    CHECK(symbol.left == 10.0);
    CHECK(symbol.right == 40.0);
    CHECK(symbol.high == 80.0);
    CHECK(symbol.low == 40.0);
    const auto nested = extent(drawing.shapes[1].filled);  // 10 x 10 in the middle of 20 x 40
    CHECK(nested.left == 50.0);
    CHECK(nested.high == 40.0);
    CHECK(nested.low == 20.0);
    CHECK(area(drawing.shapes[2].filled) == doctest::Approx(200.0));
}

TEST_CASE("svg structure: a use that refers to itself or to nothing is not printed") {
    const Drawing drawing = svg_text::draw(
        "<g id='a'><rect width='5' height='5'/><use id='loop' href='#a'/></g>"
        "<defs><g id='b'><use id='to_c' href='#c'/></g><g id='c'><use id='to_b' href='#b'/></g></defs>"
        "<use id='start' href='#b'/><use id='gone' href='#nothing'/><use id='file' href='other.svg#x'/><use "
        "id='none'/>"
        "<use id='self' href='#self'/>");
    CHECK(drawing.shapes.size() == 1);
    CHECK(svg_text::warns(drawing, "use 'loop': refers to itself by '#a'"));
    CHECK(svg_text::warns(drawing, "use 'to_b': refers to itself by '#b'"));
    CHECK(svg_text::warns(drawing, "use 'self': refers to itself"));
    CHECK(svg_text::warns(drawing, "use 'gone': there is no element '#nothing' in this file"));
    CHECK(svg_text::warns(drawing, "use 'file': there is no element 'other.svg#x' in this file"));
}

TEST_CASE("svg structure: of a switch the first child that can be shown is drawn") {
    const Drawing drawing = svg_text::draw(
        "<switch><foreignObject requiredExtensions='&amp;ns_ai;'/><g><rect id='yes' width='5' "
        "height='5'/></g>"
        "<rect id='no' width='5' height='5'/></switch>"
        "<switch><rect id='de' systemLanguage='de' width='5' height='5'/>"
        "<rect id='en' systemLanguage='en-GB, fr' width='5' height='5'/></switch>");
    CHECK(ids(drawing) == Ids{"yes", "en"});
    CHECK(drawing.warnings.empty());
}

TEST_CASE("svg structure: what is not printed is listed with id and line, definitions are not") {
    const Drawing drawing = svg_text::draw(
        "<defs><clipPath id='c'><rect width='1' height='1'/></clipPath><mask id='m'/><filter id='f'/><marker "
        "id='k'/>"
        "<rect width='9' height='9'/></defs>\n<text id='note'>hi</text>\n<image id='photo'/>\n"
        "<foreignObject/>\n<rect id='r' width='5' height='5' clip-path='url(#c)' mask='url(#m)' "
        "style='filter:url(#f)'/>\n<path id='p' d='M0 50h9' stroke='red' marker-end='url(#k)'/>\n"
        "<rectt id='typo'/><metadata><text/></metadata><sodipodi:namedview/><title>x</title>");
    CHECK(drawing.shapes.size() == 2);
    for (const char* text :
         {"drawing.svg:3: text 'note': text is not printed; convert it to paths",
          "drawing.svg:4: image 'photo': is not printed", "drawing.svg:5: foreignObject: is not printed",
          "drawing.svg:6: rect 'r': clip-path url(#c) is ignored",
          "drawing.svg:6: rect 'r': mask url(#m) is ignored",
          "drawing.svg:6: rect 'r': filter url(#f) is ignored",
          "drawing.svg:7: path 'p': its markers are not printed",
          "drawing.svg:8: rectt 'typo': is no element that can be printed"}) {
        CAPTURE(std::string(text));
        CHECK(svg_text::warns(drawing, text));
    }
    CHECK(drawing.warnings.size() == 8);
}

TEST_CASE("svg structure: a hidden layer is one remark, whatever is in it") {
    const Drawing drawing = svg_text::draw(
        "<g id='guides' style='display:none'><text/><rect width='5' height='5'/></g><rect width='5' "
        "height='5'/>");
    CHECK(drawing.shapes.size() == 1);
    REQUIRE(drawing.warnings.size() == 1);
    CHECK(svg_text::warns(drawing, "g 'guides': is hidden: not printed"));
}

TEST_CASE("svg structure: remarks are few however many there would be") {
    std::string body;
    for (int i = 0; i < 1000; ++i) body += "<text id='t" + std::to_string(i) + "'/>\n";
    const Drawing drawing = svg_text::draw(body);
    CHECK(drawing.warnings.size() == 101);
    CHECK(drawing.warnings.back() == "... and 900 more of such remarks");
}

TEST_CASE("svg structure: elements may carry the prefix svg") {
    const Drawing drawing = svg_text::read(
        "<svg:svg xmlns:svg='http://www.w3.org/2000/svg' width='10mm' height='10mm' viewBox='0 0 10 10'>"
        "<svg:g><svg:rect width='5' height='5'/></svg:g></svg:svg>");
    CHECK(area(drawing.shapes.at(0).filled) == doctest::Approx(25.0));
}
