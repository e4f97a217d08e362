#include "ruche/output/exporters.hpp"

#include <doctest/doctest.h>

#include <clocale>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "output/sample_results.hpp"
#include "ruche/core/atomic_file.hpp"

using namespace ruche;

namespace {

/// One triangle with a front print, one bare; lifted out of the plane at one corner.
Result two_triangles() {
    TriangleMesh mesh;
    mesh.vertices = {{0, 0}, {2, 0}, {2, 2}, {0, 2}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    return sample::result(
        mesh, {{"a strip", [](const Vec2& p) { return p.x() > p.y(); }, {.front = 0.6}}},
        [](const Vec2& p) { return Vec3(p.x(), p.y(), p.y() > 1 && p.x() < 1 ? 0.5 : 0.0); });
}

ExportSurface released(const Result& result) { return released_surface(result, surface_fields(result)); }

std::string body_after(const std::string& text, const std::string& mark) {
    const std::size_t at = text.find(mark);
    REQUIRE(at != std::string::npos);
    return text.substr(at + mark.size());
}

template <class Number>
Number number_at(const std::string& bytes, std::size_t at) {
    Number value;
    REQUIRE(at + sizeof value <= bytes.size());
    std::memcpy(&value, bytes.data() + at, sizeof value);
    return value;
}

struct Glb {
    nlohmann::json json;
    std::string binary;
};

Glb parse_glb(const std::string& file) {
    CHECK(file.substr(0, 4) == "glTF");
    CHECK(number_at<std::uint32_t>(file, 8) == file.size());
    const auto length = number_at<std::uint32_t>(file, 12);
    CHECK(length % 4 == 0);
    CHECK(number_at<std::uint32_t>(file, 20 + length) == file.size() - 28 - length);
    return {nlohmann::json::parse(file.substr(20, length)), file.substr(28 + length)};
}

}  // namespace

TEST_CASE("obj: two triangles are written as they are, bare fabric first, a group and a material per strip") {
    const std::string text = to_obj(released(two_triangles()), "shape.mtl");
    CHECK(
        text.starts_with("# sample (mm; vt: the flat layout)\nmtllib shape.mtl\nv 0 0 0\nv 2 0 0\n"
                         "v 2 2 0\nv 0 2 0.5\nvt 0 0\n"));
    CHECK(
        text.ends_with("g fabric\nusemtl fabric\nf 1/1/1 3/3/3 4/4/4\n"
                       "g a_strip\nusemtl plastic_front\nf 1/1/1 2/2/2 3/3/3\n"));
}

TEST_CASE("obj: the layout has the same connectivity and z = 0") {
    const Result result = two_triangles();
    const std::string flat = to_obj(layout_surface(result, surface_fields(result)), "layout.mtl");
    CHECK(flat.find("v 0 2 0\n") != std::string::npos);
    CHECK(body_after(flat, "g fabric") == body_after(to_obj(released(result), "shape.mtl"), "g fabric"));
}

TEST_CASE("obj: numbers do not depend on the locale and come back exactly") {
    Result result = two_triangles();
    result.shape[1].x() = 1.0 / 3.0;
    const std::string before = to_obj(released(result), "m.mtl");
    std::setlocale(LC_ALL, "de_DE.UTF-8");
    const std::string after = to_obj(released(result), "m.mtl");
    std::setlocale(LC_ALL, "C");
    CHECK(before == after);
    CHECK(before.find("v 0.3333333333333333 0 0\n") != std::string::npos);
}

TEST_CASE("ply: header and first rows are what was put in") {
    const std::string file = to_ply(released(two_triangles()));
    CHECK(file.find(
              "property list uchar int vertex_indices\nproperty double front_mm\nproperty double back_mm\n"
              "property int side\nproperty int strip\nproperty int front_strip\nproperty int "
              "back_strip\nproperty float curvature_max_per_mm\n") != std::string::npos);
    CHECK(file.find("end_header\n0 0 0 ") != std::string::npos);
    CHECK(file.find("\n0 2 0.5 ") != std::string::npos);
    CHECK(file.find("\n3 0 1 2 0.6 0 1 0 ") != std::string::npos);
    CHECK(file.find("\n3 0 2 3 0 0 0 -1 ") != std::string::npos);
}

TEST_CASE("vtu: arrays are base64 with their length first") {
    const std::string file = to_vtu(released(two_triangles()));
    // 2 bytes of cell types: length 2 as 8 bytes, then 5, 5.
    CHECK(file.find("Name=\"types\" format=\"binary\">AgAAAAAAAAAFBQ==</DataArray>") != std::string::npos);
    CHECK(file.find("Name=\"mean_curvature_per_mm\"") != std::string::npos);
}

TEST_CASE("stl: 50 bytes per triangle after the header, normals to the front") {
    const std::string file = to_stl(released(two_triangles()));
    CHECK(file.size() == 84 + 2 * 50);
    CHECK(number_at<std::uint32_t>(file, 80) == 2);
    CHECK(number_at<float>(file, 84 + 8) == 1.0F);
}

TEST_CASE("glb: in metres, y up, fabric and plastic apart, the plastic as thick as printed") {
    Result flat = two_triangles();
    flat.shape[3].z() = 0;
    const Glb glb = parse_glb(to_glb(flat));
    REQUIRE(glb.json["meshes"].size() == 2);
    CHECK(glb.json["meshes"][0]["name"] == "fabric");
    CHECK(glb.json["meshes"][1]["name"] == "plastic_front");
    const auto bounds = [&](int mesh, const char* which) {
        const int accessor = glb.json["meshes"][mesh]["primitives"][0]["attributes"]["POSITION"];
        return glb.json["accessors"][accessor][which].get<std::array<float, 3>>();
    };
    CHECK(bounds(0, "max") == std::array<float, 3>{0.002F, 0.0F, 0.0F});
    CHECK(bounds(0, "min") == std::array<float, 3>{0.0F, 0.0F, -0.002F});
    CHECK(bounds(1, "max")[1] == doctest::Approx(0.6e-3));
    CHECK(bounds(1, "min")[1] == doctest::Approx(0.0));
    CHECK(glb.binary.size() == glb.json["buffers"][0]["byteLength"]);
    for (const auto& material : glb.json["materials"]) CHECK(material["doubleSided"] == true);
}

TEST_CASE("exporters: a position that is not finite is an error that names the vertex") {
    Result result = two_triangles();
    result.shape[2].y() = std::numeric_limits<double>::quiet_NaN();
    CHECK_THROWS_WITH_AS(released(result), doctest::Contains("vertex 2"), std::runtime_error);
}

TEST_CASE("exporters: every format of a rolled sheet is written for other programs to read") {
    // Python tests set the folder and open the files with meshio and assimp.
    const char* given = std::getenv("RUCHE_EXPORT_FOLDER");
    if (given == nullptr) return;
    const std::string folder = given;
    const Result result = sample::rolled_sheet();
    const std::vector<double> density(result.layout.mesh.triangles.size(), 0.25);
    const SurfaceFields fields = surface_fields(result, density);
    const ExportSurface shape = released_surface(result, fields), layout = layout_surface(result, fields);
    for (const auto& [name, surface] : {std::pair("shape", &shape), std::pair("layout", &layout)}) {
        const std::string stem = folder + "/" + name;
        write_file_atomically(stem + ".obj", to_obj(*surface, "shape.mtl"));
        write_file_atomically(stem + ".ply", to_ply(*surface));
        write_file_atomically(stem + ".vtu", to_vtu(*surface));
        write_file_atomically(stem + ".stl", to_stl(*surface));
    }
    write_file_atomically(folder + "/shape.mtl", obj_materials());
    write_file_atomically(folder + "/shape.glb", to_glb(result));
    CHECK(std::filesystem::exists(folder + "/shape.glb"));
}
