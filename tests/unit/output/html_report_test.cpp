#include "ruche/output/html_report.hpp"

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

#include "output/sample_results.hpp"

using namespace ruche;

namespace {

/// The content of the script element with that id.
std::string content(const std::string& html, const std::string& id) {
    const std::size_t begin = html.find("<script id=\"" + id + "\"");
    REQUIRE(begin != std::string::npos);
    const std::size_t from = html.find('>', begin) + 1;
    return html.substr(from, html.find("</script>", from) - from);
}

std::string page_of(const Result& result) { return html_report(result, surface_fields(result)); }

}  // namespace

// Without npm the program has no page: nothing to test then.
TEST_CASE("page: holds the report, the arrays and where they lie" * doctest::skip(!can_write_page())) {
    const Result result = sample::rolled_sheet();
    const std::string html = page_of(result);
    const auto report = nlohmann::json::parse(content(html, "ruche-report"));
    CHECK(report["strips"].size() == 3);
    const auto page = nlohmann::ordered_json::parse(content(html, "ruche-page"));
    const auto triangles = result.layout.mesh.triangles.size();
    CHECK(page["arrays"]["triangles"]["count"] == triangles);
    CHECK(page["arrays"]["shape_mm"]["count"] == result.shape.size());
    CHECK(page["rotation"].size() == 9);
    CHECK_FALSE(page.contains("film"));
    std::size_t end = 0;
    for (const auto& array : page["arrays"]) {
        const std::size_t size = array["type"] == "u8" ? 1 : array["type"] == "u32" ? 4 : 2;
        CHECK(array["at"].get<std::size_t>() >= end);
        end = array["at"].get<std::size_t>() +
              size * array["count"].get<std::size_t>() * array["components"].get<std::size_t>();
    }
    CHECK(content(html, "ruche-arrays").size() == (end + 2) / 3 * 4);
}

TEST_CASE("page: a strip's name cannot end the script that it stands in" * doctest::skip(!can_write_page())) {
    Result result = sample::rolled_sheet();
    result.layout.strips[0].id = "</script><script>alert(1)</script>";
    result.warnings.emplace_back("<!-- \xff -->");
    const std::string html = page_of(result);
    CHECK(html.find("alert(1)</script>") == std::string::npos);
    CHECK(nlohmann::json::parse(content(html, "ruche-report"))["strips"][0]["id"] ==
          result.layout.strips[0].id);
}

TEST_CASE("page: names nothing outside itself that a browser would fetch" *
          doctest::skip(!can_write_page())) {
    const std::string html = page_of(sample::rolled_sheet());
    for (const char* fetching : {"<link ", "<img ", " src=\"http", "@import", "url(http"})
        CHECK(html.find(fetching) == std::string::npos);
    CHECK(html.find("default-src 'none'") != std::string::npos);
}

TEST_CASE("page: the film's frames follow the arrays" * doctest::skip(!can_write_page())) {
    Result result = sample::rolled_sheet();
    std::vector<Vec3> flat;
    for (const Vec2& v : result.layout.mesh.vertices) flat.emplace_back(v.x(), v.y(), 0.0);
    result.film = ReleaseFilm{.layout = result.layout,
                              .frames = {{0.0, {1, 1}, flat}, {0.5, {1.2, 1.3}, result.shape}}};
    const auto page = nlohmann::json::parse(content(page_of(result), "ruche-page"));
    CHECK(page["film"]["frames"].size() == 2);
    CHECK(page["film"]["frames"][1]["prestretch"] == nlohmann::json({1.2, 1.3}));
    CHECK(page["arrays"]["film_frames_mm"]["count"] == 2 * flat.size());
}

TEST_CASE("page: positions that are not finite are an error" * doctest::skip(!can_write_page())) {
    Result result = sample::rolled_sheet();
    result.shape[3].y() = std::nan("");
    CHECK_THROWS_WITH_AS(page_of(result), doctest::Contains("not finite"), std::runtime_error);
}
