#include <doctest/doctest.h>

#include <limits>
#include <string>
#include <vector>

#include "ruche/core/error.hpp"
#include "svg_text.hpp"

using namespace ruche;
using svg_text::on_page;

namespace {

std::string repeated(const std::string& text, int count) {
    std::string all;
    for (int i = 0; i < count; ++i) all += text;
    return all;
}

/// Every group uses the one before it ten times.
std::string exploding_uses(int levels, const std::string& leaf) {
    std::string body = "<defs><g id='g0'>" + leaf + "</g>";
    for (int i = 1; i <= levels; ++i) {
        body += "<g id='g" + std::to_string(i) + "'>" +
                repeated("<use href='#g" + std::to_string(i - 1) + "'/>", 10) + "</g>";
    }
    return on_page(body + "</defs><use href='#g" + std::to_string(levels) + "'/>");
}

std::string zigzag(int count) {
    std::string d = "M0 0";
    for (int i = 0; i < count; ++i) d += "L" + std::to_string(i * 61 % 97) + " " + std::to_string(i % 2 * 90);
    return on_page("<path id='z' fill='none' stroke='red' d='" + d + "'/>");
}

struct Case {
    std::string name, text, says;
};

std::vector<Case> wrong_files() {
    const std::string rect = "<rect width='5' height='5'/>";
    return {
        {"empty", "", "is empty"},
        {"blank", " \n\t\n", "is empty"},
        {"binary", std::string("\x89PNG\r\n\x1a\n\0\0\0\rIHDR", 16), "is not text"},
        {"zeros", std::string(100, '\0'), "is not text"},
        {"gzip", "\x1f\x8b\x08 and so on", "is a compressed SVG"},
        {"pdf", "%PDF-1.7\n", "is a PDF or PostScript file"},
        {"prose", "hello world", "not well-formed XML"},
        {"truncated", "<svg width='10mm' height='10mm'>\n<g>\n<rect wid",
         "drawing.svg:3: is not well-formed XML"},
        {"unclosed", "<svg>\n<g>\n</svg>", "drawing.svg:3: is not well-formed XML"},
        {"attribute", "<svg>\n<rect width=5/></svg>", "drawing.svg:2: is not well-formed XML"},
        {"html", "<html><svg/></html>", "drawing.svg:1: the outermost element is <html>, not <svg>"},
        {"comment only", "<!-- nothing -->", "not well-formed XML: no document element found"},
        {"not utf-8",
         "<svg>\n<title>K\xfc"
         "che</title></svg>",
         "drawing.svg:2: the text is not UTF-8"},
        {"unknown encoding", "<?xml version='1.0' encoding='Shift_JIS'?><svg><title>\x82\xa0</title></svg>",
         "the encoding 'shift_jis' is not supported"},
        {"no length", "<svg width='wide' height='3mm'/>", "width: 'wide' is not a length"},
        {"zero page", "<svg width='0mm' height='3mm'/>", "width: '0mm' is not positive"},
        {"negative page", "<svg width='3mm' height='-3mm'/>", "height: '-3mm' is not positive"},
        {"nan page", "<svg width='nanmm' height='3mm'/>", "width: 'nanmm' is not a length"},
        {"huge page", "<svg width='1e9mm' height='3mm'/>", "the page is 1e+09 x 3 mm"},
        {"infinite page", "<svg width='1e308in' height='1e308in'/>", "the page is"},
        {"view box of three", "<svg viewBox='0 0 3'/>", "viewBox: '0 0 3' is not four numbers"},
        {"empty view box", "<svg viewBox='0 0 0 3'/>", "viewBox: '0 0 0 3' has a width or height"},
        {"far away", on_page("<rect id='far' x='1e9' width='5' height='5'/>"),
         "rect 'far': reaches to (1e+09, 100) mm; at most 100 m are allowed"},
        {"far path", on_page("<path d='M0 0L1e9 0'/>"), "reaches to"},
        {"far control", on_page("<path d='M0 0C1e300 0 0 0 5 5'/>"), "reaches to"},
        {"far arc", on_page("<path d='M0 0A1e9 1e9 0 1 1 5 5'/>"), "reaches to"},
        {"far by transform", on_page("<g transform='scale(1e12)'>" + rect + "</g>"), "reaches to"},
        {"infinite by transforms",
         on_page("<g transform='scale(1e200)'><g transform='scale(1e200)'>" + rect + "</g></g>"),
         "reaches to"},
        {"wide stroke", on_page("<path d='M0 0h5' stroke='red' stroke-width='1e9'/>"), "reaches to"},
        {"infinite circle", on_page("<circle r='1e308'/>"), "reaches to"},
        {"100,000 deep", on_page(repeated("<g>", 100000) + rect + repeated("</g>", 100000)),
         "elements are nested more than 200 deep"},
        {"100,000 deep, never closed", "<svg>" + repeated("<g>", 100000), "not well-formed XML"},
        {"deep by use",
         [&] {
             std::string body = "<defs><g id='u0'>" + rect + "</g>";
             for (int i = 1; i < 1000; ++i) {
                 body +=
                     "<g id='u" + std::to_string(i) + "'><use href='#u" + std::to_string(i - 1) + "'/></g>";
             }
             return on_page(body + "</defs><use href='#u999'/>");
         }(),
         "elements and uses are nested more than 200 deep"},
        {"exploding uses", exploding_uses(20, rect), "use elements repeat more than 100000 elements"},
        {"exploding uses of nothing", exploding_uses(20, ""),
         "use elements repeat more than 100000 elements"},
        {"too many shapes", on_page(repeated(rect, 60000)), "the drawing has more than 50000 shapes"},
        {"too many points", exploding_uses(4, "<path d='M0 0" + repeated("h.01v.01", 100) + "'/>"),
         "points at a tolerance of"},
        {"tangled", zigzag(20000), "path 'z': the lines cross each other too often"},
        {"heap of wide lines",
         on_page("<path id='h' fill='none' stroke='red' stroke-width='30' d='" +
                 repeated("M50 50l1 1M50 51l1-1", 2000) + "'/>"),
         "path 'h': the lines cross each other too often"},
        {"many attributes",
         on_page("<rect" +
                 [] {
                     std::string all;
                     for (int i = 0; i < 5000; ++i) all += " a" + std::to_string(i) + "=''";
                     return all;
                 }() +
                 "/>"),
         "has 5000 attributes"},
        {"entangled sheet",
         on_page("<style>" + repeated("g g g g rect{fill:red}", 3000) + "</style>" + repeated("<g>", 150) +
                 repeated(rect, 3000) + repeated("</g>", 150)),
         "the style sheet is too entangled"},
    };
}

/// Harmless though they look otherwise: the number of shapes that must come out.
struct Harmless {
    std::string name, text;
    std::size_t shapes;
};

std::vector<Harmless> odd_files() {
    std::string bomb = "<!DOCTYPE svg [\n<!ENTITY l0 \"lol\">\n";
    for (int i = 1; i < 12; ++i) {
        bomb += "<!ENTITY l" + std::to_string(i) + " \"" + repeated("&l" + std::to_string(i - 1) + ";", 10) +
                "\">\n";
    }
    bomb +=
        "]>\n<svg width='9mm' height='9mm'><rect width='5' height='5' "
        "style='&l11;&l11;'/><text>&l11;</text></svg>";
    const std::string rect = "<rect width='5' height='5'/>";
    return {
        {"entity bomb", bomb, 1},
        {"external entity",
         "<!DOCTYPE svg [<!ENTITY x SYSTEM 'file:///etc/passwd'>]><svg><title>&x;</title></svg>", 0},
        {"large doctype", "<!DOCTYPE svg [" + repeated("<!ENTITY a 'b'>", 100000) + "]>" + on_page(rect), 1},
        {"empty path", on_page("<path/><path d=''/><polygon/><rect/><circle/><line/>"), 0},
        {"nan", on_page("<rect x='nan' width='5' height='5'/><circle r='inf'/><path d='M nan 0L5 5'/>"), 1},
        {"negative sizes", on_page("<rect width='-5' height='5'/><circle r='-5'/><ellipse rx='3' ry='-1'/>"),
         0},
        {"long numbers", on_page("<path d='M0 0H" + std::string(100000, '1') + "'/>"), 0},
        {"many blanks", on_page("<path d='M0 0h5v5z" + std::string(200000, ' ') + "'/>"), 1},
        {"unclosed style", on_page("<style>rect{fill:red</style>" + rect), 1},
        {"brackets", on_page("<style>" + std::string(200000, '(') + "</style>" + rect), 1},
        {"braces", on_page("<style>" + std::string(200000, '{') + "</style>" + rect), 1},
        {"ampersands", on_page("<rect width='5' height='5' style='" + repeated("&amp;", 50000) + "'/>"), 1},
        {"comments", on_page("<style>" + repeated("/**/", 50000) + "</style>" + rect), 1},
        {"nothing", "<svg/>", 0},
        {"no shapes", on_page(""), 0},
        {"trailing dashes", on_page("<path d='M0 0h50' stroke='red' stroke-dasharray='1e300 1e-300'/>"), 1},
        {"empty nested svg",
         on_page("<svg width='0' height='5'>" + rect + "</svg><svg viewBox='0 0 0 1'>" + rect + "</svg>"), 0},
        {"singular", on_page("<g transform='matrix(1 1 1 1 0 0)'><path d='M0 0l5 3' stroke='red'/></g>"), 0},
    };
}

}  // namespace

TEST_CASE("svg bad input: every wrong file is one clear message") {
    for (const Case& c : wrong_files()) {
        CAPTURE(c.name);
        std::string message = "nothing was thrown", file;
        const svg_text::TemporaryFile source(c.text);
        try {
            (void)read_svg(source.path());
        } catch (const InputError& error) {
            message = error.what();
            file = error.place().file;
            CHECK_FALSE(error.advice().empty());
        }
        CAPTURE(message);
        CHECK(message.find(c.says) != std::string::npos);
        CHECK(file == source.path());
        CHECK(message.size() < 400 + source.path().size());
    }
}

TEST_CASE("svg bad input: odd but harmless files are read") {
    for (const Harmless& c : odd_files()) {
        CAPTURE(c.name);
        const svg_text::TemporaryFile source(c.text);
        const Drawing drawing = read_svg(source.path());
        CHECK(drawing.shapes.size() == c.shapes);
        for (const std::string& warning : drawing.warnings)
            CHECK(warning.size() < 500 + source.path().size());
    }
}

TEST_CASE("svg bad input: every proper part of a file is read or refused, never worse") {
    const std::string whole = on_page(
        "<style>.a{fill:none;stroke:red}</style><g transform='scale(2)'><path class='a' "
        "d='M1 1C2 3 4 5 6 7a1 1 0 01.5.5z'/><use href='#x'/></g><!-- ü -->");
    for (std::size_t length = 0; length < whole.size(); ++length) {
        try {
            (void)svg_text::read(whole.substr(0, length));
        } catch (const InputError& error) {
            CHECK(std::string(error.what()).find("drawing.svg") != std::string::npos);
        }
    }
}

TEST_CASE("svg encoding: UTF-8 with mark, UTF-16 and Latin-1 say the same") {
    const std::string body =
        "<svg width='9mm' height='9mm' viewBox='0 0 9 9'>\n<rect id='K\xc3\xbc"
        "che' width='5' height='5'/></svg>";
    const auto utf16 = [&](bool big_endian, bool mark) {
        std::string out = !mark ? "" : big_endian ? "\xfe\xff" : "\xff\xfe";
        for (std::size_t i = 0; i < body.size(); ++i) {
            const bool umlaut = body[i] == '\xc3';
            const char low = umlaut ? '\xfc' : body[i];
            if (umlaut) ++i;
            out += big_endian ? '\0' : low;
            out += big_endian ? low : '\0';
        }
        return out;
    };
    const std::string latin =
        "<?xml version='1.0' encoding='ISO-8859-1'?>\n<svg viewBox='0 0 9 9' width='9mm' "
        "height='9mm'><rect id='K\xfc"
        "che' width='5' height='5'/></svg>";
    for (const std::string& text : {body, "\xef\xbb\xbf" + body, utf16(true, true), utf16(false, true),
                                    utf16(true, false), utf16(false, false), latin}) {
        const Drawing drawing = svg_text::read(text);
        CHECK(drawing.shapes.at(0).id ==
              "K\xc3\xbc"
              "che");
        CHECK(drawing.shapes.at(0).line == 2);
    }
}

TEST_CASE("svg bad input: lines are counted for every kind of line end") {
    for (const std::string end : {"\n", "\r\n", "\r"}) {
        const Drawing drawing = svg_text::read("<svg viewBox='0 0 9 9'>" + end + "<!--" + end + "-->" + end +
                                               "<rect width='5' height='5'/></svg>");
        CHECK(drawing.shapes.at(0).line == 4);
    }
}

TEST_CASE("drawing: what is no readable drawing is refused with the way out") {
    const svg_text::TemporaryFile dxf("0\nSECTION", "plan.dxf"), ai("%PDF", "logo.AI"), none("", "noending"),
        svg("<svg/>", "ok.SVG");
    const auto message = [](const std::string& path) {
        try {
            (void)read_drawing(path);
        } catch (const InputError& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    CHECK(message(dxf.path()).find("plan.dxf: DXF drawings are not read yet\n  Export the drawing as SVG") !=
          std::string::npos);
    CHECK(message(ai.path()).find("logo.AI: .ai drawings are not read\n  Export the drawing as SVG") !=
          std::string::npos);
    CHECK(message(none.path()).find("has no ending") != std::string::npos);
    CHECK(message("kite.xyz").find("unknown ending .xyz") != std::string::npos);
    CHECK(message("kite.svgz").find("compressed") != std::string::npos);
    CHECK(message("no/such/file.svg").find("there is no such file") != std::string::npos);
    CHECK(message("/.svg").find("has no ending") != std::string::npos);
    CHECK(message(svg.path()).empty());
    const svg_text::TemporaryFile inside("", "x");
    const std::string folder = inside.path().substr(0, inside.path().size() - 1) + "folder.svg";
    std::filesystem::create_directory(folder);
    CHECK(message(folder).find("is not a file") != std::string::npos);
}

TEST_CASE("drawing: options out of range are refused by name") {
    const svg_text::TemporaryFile file("<svg/>");
    for (const double bad : {0.0, -1.0, 1e-9, 100.0, std::numeric_limits<double>::quiet_NaN()}) {
        CHECK_THROWS_WITH_AS((void)read_svg(file.path(), {.flatten_tolerance_mm = bad}),
                             doctest::Contains("flatten_tolerance_mm: "), InputError);
    }
    for (const double bad :
         {-1.0, 1e9, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()}) {
        CHECK_THROWS_WITH_AS((void)read_svg(file.path(), {.width_mm = bad}), doctest::Contains("width_mm: "),
                             InputError);
    }
}
