#include "ruche/output/report.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

using namespace ruche;
using Json = nlohmann::json;

namespace {

/// A square of two printed triangles, bent nowhere, with one strip along the diagonal.
Result printed_square() {
    Result result;
    result.layout.mesh.vertices = {{0, 0}, {10, 0}, {10, 10}, {0, 10}};
    result.layout.mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    result.layout.print = {{.front = 0.6}, {}};
    result.layout.strip = {{.front = 0}, {}};
    MeshedStrip strip{.id = "strip-1", .thickness = 0.6};
    strip.centreline = {{{0, {0.8, 0.1, 0.1}}, {0, {0.5, 0.25, 0.25}}, {0, {0.2, 0.4, 0.4}}}};
    result.layout.strips = {strip};
    for (const Vec2& x : result.layout.mesh.vertices)
        result.shape.emplace_back(0.5 * x.x(), 0.5 * x.y(), 1.0);
    result.equilibrium.status = SolveStatus::converged;
    result.equilibrium.stable = true;
    result.equilibrium.energy = {
        .fabric_membrane = 1.0, .fabric_bending = 0.5, .plastic = 2.0, .gravity = -0.25};
    result.equilibrium.residual = 1e-10;
    result.equilibrium.iterations = 9;
    result.equilibrium.factorizations = 12;
    result.equilibrium.x = Eigen::VectorXd::Zero(14);
    result.assumptions = {"fabric_thickness = 0.46 mm: not in the paper"};
    result.warnings = {"strip-1 was cut"};
    result.seconds = {{"read", 0.1}, {"release", 2.5}};
    return result;
}

}  // namespace

TEST_CASE("report: it has every key that others rely on") {
    const Json json = Json::parse(report_json(printed_square()));
    CHECK(json["status"] == "converged");
    CHECK(json["stable"] == true);
    CHECK(json["energy_mJ"]["total"] == 3.25);
    CHECK(json["energy_mJ"]["fabric_membrane"] == 1.0);
    CHECK(json["energy_mJ"]["fabric_bending"] == 0.5);
    CHECK(json["energy_mJ"]["plastic"] == 2.0);
    CHECK(json["energy_mJ"]["gravity"] == -0.25);
    CHECK(json["energy_mJ"]["contact"] == 0.0);
    CHECK(json["residual_N"] == 1e-10);
    CHECK(json["mesh"] == Json({{"vertices", 4}, {"triangles", 2}, {"unknowns", 14}}));
    CHECK(json["solver"]["iterations"] == 9);
    CHECK(json["solver"]["factorizations"] == 12);
    CHECK(json["solver"].contains("seconds"));
    for (const char* key : {"max_strain_margin", "min_area_ratio", "max_dihedral_deg", "self_intersections"})
        CHECK(json["health"].contains(key));
    CHECK(json["health"]["contact_pairs"] == 0);
    CHECK(json["health"]["smallest_gap_mm"].is_null());
    REQUIRE(json["strips"].size() == 1);
    CHECK(json["strips"][0]["id"] == "strip-1");
    CHECK(json["strips"][0]["stretch"] == doctest::Approx(0.5));
    CHECK(json["strips"][0].contains("fit_rms_mm"));
    CHECK(json["assumptions"].size() == 1);
    CHECK(json["warnings"][0] == "strip-1 was cut");
    CHECK(json["seconds"]["release"] == 2.5);
    CHECK(json["shape"]["box_size_mm"] == Json({5.0, 5.0, 0.0}));
    CHECK(json["shape"]["printed_area_mm2"] == 50.0);
    CHECK(json["version"].get<std::string>().size() > 2);
}

TEST_CASE("report: it says where the sheet passes through itself, at no more than 20 places") {
    Result result = printed_square();
    CHECK(Json::parse(report_json(result))["health"]["self_intersection_places"] == Json::array());
    result.self_intersections = {{{0, 1}, Vec3(1, 2, 3)}};
    const Json one = Json::parse(report_json(result))["health"]["self_intersection_places"];
    REQUIRE(one.size() == 1);
    CHECK(one[0]["place_mm"] == Json({1.0, 2.0, 3.0}));
    CHECK(one[0]["triangles"] == Json({0, 1}));
    CHECK(one[0]["strips"] == Json({"strip-1", nullptr}));
    // The centroids of the two halves of the square of 10 mm.
    CHECK(one[0]["layout_mm"][0][0] == doctest::Approx(20.0 / 3));
    CHECK(one[0]["layout_mm"][1][1] == doctest::Approx(20.0 / 3));
    for (int i = 0; i < 99; ++i) result.self_intersections.push_back({{0, 1}, Vec3(i, 0, 0)});
    const Json many = Json::parse(report_json(result))["health"]["self_intersection_places"];
    REQUIRE(many.size() == 20);
    CHECK(many[0]["place_mm"][0] == 1.0);
    CHECK(many[19]["place_mm"][0] == 94.0);  // of the 100 pairs, the one numbered 95
}

TEST_CASE("report: the status has the three pinned names") {
    Result result = printed_square();
    result.equilibrium.status = SolveStatus::not_converged;
    CHECK(Json::parse(report_json(result))["status"] == "not_converged");
    result.equilibrium.status = SolveStatus::interrupted;
    CHECK(Json::parse(report_json(result))["status"] == "interrupted");
}

TEST_CASE("report: a flat strip has curvature 0 and radius null") {
    const Json strip = Json::parse(report_json(printed_square()))["strips"][0];
    CHECK(std::abs(strip["curvature_per_mm"].get<double>()) < 1e-9);
    CHECK(strip["radius_mm"].is_null());
}

TEST_CASE("report: every parameter stands there with value, unit and source") {
    Result result = printed_square();
    result.scene.fabric.prestretch = {1.6, 1.65};
    result.scene.sources["fabric.prestretch"] = {"kite.toml", 14, "fabric.prestretch"};
    result.scene.material_sources["fabric_thickness"] = "assumed: implied by k_B";
    const Json parameters = Json::parse(report_json(result))["parameters"];
    for (const auto& field : fields<Material>())
        CHECK(parameters["material"].contains(std::string(field.key)));
    for (const auto& field : fields<SolveOptions>())
        CHECK(parameters["solver"].contains(std::string(field.key)));
    CHECK(parameters["fabric"]["prestretch"]["value"] == Json({1.6, 1.65}));
    CHECK(parameters["fabric"]["prestretch"]["source"] == "kite.toml:14");
    CHECK(parameters["material"]["fabric_thickness_mm"] ==
          Json({{"value", 0.46}, {"unit", "mm"}, {"source", "assumed: implied by k_B"}}));
    CHECK(parameters["mesh"]["size_mm"]["source"] == "default");
    CHECK(parameters["model"]["edge_normals"]["value"] == "free");
}

TEST_CASE("report: lists of the scene are written out") {
    Result result = printed_square();
    result.scene.plastic.rules = {{.match = "#ff0000", .thickness = 0.9, .side = Side::back}};
    SupportOptions support;
    support.max_mm = {3, 4};
    result.scene.supports = {support};
    result.scene.pattern.generator_options = {{"rings", "12:20"}};
    const Json parameters = Json::parse(report_json(result))["parameters"];
    CHECK(parameters["plastic"]["rule"][0]["match"] == "#ff0000");
    CHECK(parameters["support"][0]["max_mm"] == Json({3.0, 4.0}));
    CHECK(parameters["pattern"]["options"]["rings"] == "12:20");
}

TEST_CASE("report: it is valid JSON whatever the run came to") {
    Result result = printed_square();
    const double nan = std::numeric_limits<double>::quiet_NaN();
    result.equilibrium.energy.plastic = nan;
    result.equilibrium.residual = std::numeric_limits<double>::infinity();
    result.shape[2] = Vec3(nan, nan, nan);
    result.layout.strips[0].id = "bad \xff\xfe \"quoted\" \n \x01 gr\xc3\xbcn";
    result.warnings = {std::string("zero \0 inside", 13)};
    const Json json = Json::parse(report_json(result));
    CHECK(json["energy_mJ"]["plastic"].is_null());
    CHECK(json["energy_mJ"]["total"].is_null());
    CHECK(json["residual_N"].is_null());
    CHECK(json["strips"][0]["curvature_per_mm"].is_null());
    const auto id = json["strips"][0]["id"].get<std::string>();
    CHECK(id.find("\"quoted\"") != std::string::npos);
    CHECK(id.find("gr\xc3\xbcn") != std::string::npos);
    CHECK(Json::parse(report_json(Result{}))["strips"].empty());
}
