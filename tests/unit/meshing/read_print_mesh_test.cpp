#include <doctest/doctest.h>
#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "ruche/core/error.hpp"
#include "ruche/meshing/print_mesh.hpp"

using namespace ruche;

namespace {

/// A folder in the temporary folder that goes away with the test.
class Folder {
  public:
    Folder() {
        path_ = std::filesystem::temp_directory_path() /
                ("ruche-mesh-" + std::to_string(reinterpret_cast<std::uintptr_t>(this)));
        std::filesystem::create_directories(path_);
    }
    ~Folder() { std::filesystem::remove_all(path_); }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;

    std::string write(const std::string& name, const std::string& text) const {
        std::ofstream(path_ / name, std::ios::binary) << text;
        return (path_ / name).string();
    }

  private:
    std::filesystem::path path_;
};

const std::string square_vertices = "0 0\n2 0\n2 2\n0 2\n";

std::string ply(const std::string& properties, const std::string& faces,
                const std::string& vertices = square_vertices) {
    const auto count = [](const std::string& text) { return std::ranges::count(text, '\n'); };
    return fmt::format(
        "ply\nformat ascii 1.0\ncomment made by hand\nelement vertex {}\nproperty float x\nproperty float y\n"
        "element face {}\nproperty list uchar int vertex_indices\n{}end_header\n{}{}",
        count(vertices), count(faces), properties, vertices, faces);
}

const std::string both_sides = "property double front_mm\nproperty double back_mm\n";
const std::string good_faces = "3 0 1 2 0.6 0\n3 0 2 3 0 0.4\n";

std::string problem_of(const std::string& path, const std::string& table = {}) {
    try {
        (void)read_print_mesh(path, table);
    } catch (const InputError& error) {
        return error.what();
    }
    return "no error";
}

bool contains_text(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

/// A strip of 2 x n triangles as text: 20 x 1 mm on a sheet with fabric above it.
std::string strip_ply(int n) {
    std::string vertices;
    std::string faces;
    for (int j = 0; j < 3; ++j) {
        for (int i = 0; i <= n; ++i) vertices += fmt::format("{} {}\n", 20.0 * i / n, j);
    }
    for (int j = 0; j < 2; ++j) {
        for (int i = 0; i < n; ++i) {
            const int a = j * (n + 1) + i;
            const double front = j == 0 ? 0.6 : 0.0;
            faces += fmt::format("3 {} {} {} {} 0\n3 {} {} {} {} 0\n", a, a + 1, a + n + 2, front, a,
                                 a + n + 2, a + n + 1, front);
        }
    }
    return ply(both_sides, faces, vertices);
}

}  // namespace

TEST_CASE("mesh input: an ASCII PLY gives the mesh, the print and the strips") {
    const Folder folder;
    const PrintMesh m = read_print_mesh(folder.write("a b \xc3\xbc.ply", ply(both_sides, good_faces)));
    CHECK(m.mesh.vertices == std::vector<Vec2>{{0, 0}, {2, 0}, {2, 2}, {0, 2}});
    CHECK(m.mesh.triangles == std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}});
    CHECK(m.print == std::vector<Print>{{.front = 0.6}, {.back = 0.4}});
    REQUIRE(m.strips.size() == 2);
    CHECK(m.strip == std::vector<StripPair>{{.front = 0}, {.back = 1}});
    CHECK(m.strips[0].side == Side::front);
    CHECK(m.strips[1].side == Side::back);
    CHECK(m.strips[1].thickness == 0.4);
    CHECK(m.warnings.empty());
}

TEST_CASE("mesh input: a negative thickness_mm is printed on the back") {
    const Folder folder;
    const PrintMesh m = read_print_mesh(
        folder.write("m.ply", ply("property float thickness_mm\n", "3 0 1 2 0.5\n3 0 2 3 -0.25\n")));
    CHECK(m.print == std::vector<Print>{{.front = 0.5}, {.back = 0.25}});
}

TEST_CASE("mesh input: binary PLY of both byte orders equals the text") {
    const Folder folder;
    for (const bool big : {false, true}) {
        std::string data = fmt::format(
            "ply\nformat binary_{}_endian 1.0\nelement vertex 4\nproperty double x\nproperty float y\n"
            "property uchar red\nelement face 2\nproperty double front_mm\nproperty list uchar uint "
            "vertex_index\nproperty list ushort float other\nproperty float back_mm\nelement edge 1\n"
            "property int a\nend_header\n",
            big ? "big" : "little");
        const auto put = [&](auto value) {
            std::array<char, sizeof(value)> raw;
            std::memcpy(raw.data(), &value, sizeof(value));
            if (big == (std::endian::native == std::endian::little)) std::reverse(raw.begin(), raw.end());
            data.append(raw.data(), raw.size());
        };
        for (const Vec2& x : {Vec2(0, 0), Vec2(2, 0), Vec2(2, 2), Vec2(0, 2)}) {
            put(x.x());
            put(static_cast<float>(x.y()));
            put(std::uint8_t{255});
        }
        for (const Triangle& tri : {Triangle{0, 1, 2}, Triangle{0, 2, 3}}) {
            put(tri[1] == 1 ? 0.6 : 0.0);
            put(std::uint8_t{3});
            for (const int v : tri) put(static_cast<std::uint32_t>(v));
            put(std::uint16_t{2});
            put(1.0F);
            put(2.0F);
            put(tri[1] == 1 ? 0.0F : 0.5F);
        }
        const std::size_t without_edge = data.size();
        put(std::int32_t{7});
        const PrintMesh m = read_print_mesh(folder.write("m.ply", data));
        CHECK(m.mesh.vertices == std::vector<Vec2>{{0, 0}, {2, 0}, {2, 2}, {0, 2}});
        CHECK(m.mesh.triangles == std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}});
        CHECK(m.print == std::vector<Print>{{.front = 0.6}, {.back = 0.5}});
        for (const std::size_t length : {data.size() - 1, without_edge - 2, without_edge - 60}) {
            const std::string problem = problem_of(folder.write("t.ply", data.substr(0, length)));
            CHECK(contains_text(problem, "the file ends here"));
        }
    }
}

TEST_CASE("mesh input: a strip has one number for both sides, or one for each") {
    const Folder folder;
    const std::string faces = "3 0 1 2 0.6 0.4 7 3\n3 0 2 3 0.6 0 7 3\n";
    const auto strips = [&](const std::string& first, const std::string& second) {
        const std::string properties =
            both_sides + "property int " + first + "\nproperty int " + second + "\n";
        return read_print_mesh(folder.write("m.ply", ply(properties, faces)));
    };
    const PrintMesh one = strips("strip", "other");
    CHECK(one.strip == std::vector<StripPair>{{0, 0}, {.front = 0}});
    CHECK(one.strips.size() == 1);
    CHECK(one.strips[0].side == Side::front);
    const PrintMesh two = strips("front_strip", "back_strip");
    CHECK(two.strip == std::vector<StripPair>{{1, 0}, {.front = 1}});
    REQUIRE(two.strips.size() == 2);
    CHECK(two.strips[0].side == Side::back);
    CHECK(two.strips[0].thickness == 0.4);
    CHECK(strips("strip", "back_strip").strip == std::vector<StripPair>{{1, 0}, {.front = 1}});
}

TEST_CASE("mesh input: OBJ with a table of thicknesses") {
    const Folder folder;
    const std::string obj = folder.write("m.obj",
                                         "# a sheet\nmtllib x.mtl\nv 0 0 1\nv 2 0 1\nv 2 2 1\nv 0 2 1\nvt 0 "
                                         "0\nf 1/1 2/1/3 3//2\nf -4 -2 -1\n");
    const PrintMesh m = read_print_mesh(
        obj, folder.write("t.csv", "# comment\ntriangle, front_mm, back_mm\n1; 0.2 ; 0.3 # both\n\n0,0.6\n"));
    CHECK(m.mesh.triangles == std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}});
    CHECK(m.print == std::vector<Print>{{.front = 0.6}, {.front = 0.2, .back = 0.3}});
    REQUIRE(m.strips.size() == 3);
    CHECK(m.strip == std::vector<StripPair>{{.front = 0}, {.front = 1, .back = 2}});
    CHECK(m.strips[1].side == Side::front);
    CHECK(m.strips[2].side == Side::back);
    CHECK(m.strips[2].thickness == 0.3);
    const PrintMesh bare = read_print_mesh(obj, folder.write("e.csv", "triangle,front_mm\n"));
    CHECK(bare.strips.empty());
    CHECK(bare.strip == std::vector<StripPair>(2));
}

TEST_CASE("mesh input: a clockwise sheet is turned, unused vertices are left out with a warning") {
    const Folder folder;
    const PrintMesh m = read_print_mesh(
        folder.write("m.ply", ply(both_sides, "3 1 3 2 0.6 0\n3 1 4 3 0 0\n", "9 9\n0 0\n2 0\n2 2\n0 2\n")));
    CHECK(m.mesh.vertex_count() == 4);
    for (int t = 0; t < 2; ++t) CHECK(layout_area(m.mesh, t) == doctest::Approx(2));
    REQUIRE(m.warnings.size() == 1);
    CHECK(contains_text(m.warnings[0], "1 vertices"));
}

TEST_CASE("mesh input: a strip's centre line runs along its middle from end to end") {
    const Folder folder;
    const PrintMesh m = read_print_mesh(folder.write("m.ply", strip_ply(20)));
    REQUIRE(m.strips.size() == 1);
    REQUIRE(m.strips[0].centreline.size() == 1);
    const auto& line = m.strips[0].centreline[0];
    CHECK(line.size() > 30);
    double left = 20;
    double right = 0;
    for (const MeshPoint& p : line) {
        CHECK(m.strip[p.triangle] == StripPair{.front = 0});
        Vec2 x = Vec2::Zero();
        for (int k = 0; k < 3; ++k) x += p.weights[k] * m.mesh.vertices[m.mesh.triangles[p.triangle][k]];
        // A midline of a region is good to 1 % of its border; its last points may lean towards a corner.
        const bool near_end = x.x() < 0.5 || x.x() > 19.5;
        CHECK(std::abs(x.y() - 0.5) < (near_end ? 0.3 : 0.02));
        left = std::min(left, x.x());
        right = std::max(right, x.x());
    }
    CHECK(left < 0.6);
    CHECK(right > 19.4);
}

TEST_CASE("mesh input: every mistake is one clear error") {
    const Folder folder;
    const auto bad = [&](const std::string& text) { return problem_of(folder.write("bad.ply", text)); };
    const auto faces = [&](const std::string& f) { return bad(ply(both_sides, f)); };
    const auto vertices = [&](const std::string& v) { return bad(ply(both_sides, good_faces, v)); };
    CHECK(contains_text(problem_of("/nowhere/m.ply"), "/nowhere/m.ply"));
    CHECK(contains_text(problem_of(folder.write("m.stl", "solid")), "\".stl\""));
    CHECK(contains_text(bad(""), "begin with \"ply\""));
    CHECK(contains_text(bad("solid\n"), "begin with \"ply\""));
    CHECK(contains_text(bad("ply\n"), "ends within its header"));
    CHECK(contains_text(bad("ply\nend_header\n"), "no format"));
    CHECK(contains_text(bad("ply\nformat binary 1.0\nend_header\n"), "unknown format \"binary\""));
    CHECK(contains_text(bad("ply\nformat ascii 1.0\nelement vertex -1\nend_header\n"),
                        "not a number of vertex"));
    CHECK(contains_text(bad("ply\nformat ascii 1.0\nelement vertex 1e18\nend_header\n"),
                        "not a number of vertex"));
    CHECK(contains_text(bad("ply\nformat ascii 1.0\nproperty int x\nend_header\n"),
                        "before the first element"));
    CHECK(contains_text(bad("ply\nformat ascii 1.0\nelement vertex 1\nproperty real x\nend_header\n"),
                        "\"real\""));
    CHECK(contains_text(bad("ply\nformat ascii 1.0\nnonsense\nend_header\n"), "\"nonsense\""));
    CHECK(contains_text(bad(ply("", "3 0 1 2\n")), "neither front_mm"));
    CHECK(contains_text(bad(ply(both_sides + "property float thickness_mm\n", "3 0 1 2 0 0 0\n")), "both"));
    CHECK(contains_text(bad(ply(both_sides, "")), "no triangles"));
    CHECK(contains_text(faces("4 0 1 2 3 0.6 0\n"), "4 corners"));
    CHECK(contains_text(faces("3 0 1 7 0.6 0\n"), "vertex 7, but there are 4"));
    CHECK(contains_text(faces("3 0 1 -1 0.6 0\n"), "triangle 0"));
    CHECK(contains_text(faces("3 0 1 1 0.6 0\n"), "the same vertex"));
    CHECK(contains_text(faces("3 0 1 2 nan 0\n"), "thickness of nan"));
    CHECK(contains_text(faces("3 0 1 2 0 -1\n"), "thickness of -1"));
    CHECK(contains_text(faces("3 0 1 2 0 inf\n"), "thickness of inf"));
    CHECK(contains_text(faces("3 0 1 2 0.6\n"), "ends too early"));
    CHECK(contains_text(faces("3 0 1 2 0,6 0\n"), "\"0,6\" is not a number"));
    CHECK(contains_text(faces("3 0 1 2 0.6 0\n3 0 3 2 0 0\n"), "1 of 2 triangles are clockwise"));
    CHECK(contains_text(faces("3 0 1 2 0.6 0\n3 0 2 3 0 0\n3 0 1 3 0 0\n"), "mesh edge"));
    CHECK(contains_text(vertices("0 0\n2 0\n2 nan\n0 2\n"), "vertex 2"));
    CHECK(contains_text(vertices("0 0\n2 0\n2 1e9\n0 2\n"), "millimetres"));
    CHECK(contains_text(vertices("0 0\n2 0\n4 0\n0 2\n"), "no area"));
    CHECK(contains_text(vertices("0 0\n2 0\n2 2\n2 0\n"), "lies on vertex 1"));
    CHECK(contains_text(
        bad(ply(both_sides, good_faces).replace(ply(both_sides, good_faces).rfind("3 0 2 3"), 20, "")),
        "1 more face elements are missing"));

    const std::string obj = folder.write("m.obj", "v 0 0 0\nv 2 0 0\nv 2 2 0\nf 1 2 3\n");
    const auto table = [&](const std::string& text) { return problem_of(obj, folder.write("t.csv", text)); };
    CHECK(contains_text(problem_of(obj), "thickness_table"));
    CHECK(contains_text(problem_of(folder.write("m.ply", ply(both_sides, good_faces)), "t.csv"),
                        "for OBJ meshes"));
    CHECK(contains_text(table("0,0.6\n1,0.6\n"), "t.csv:2: there is no triangle 1"));
    CHECK(contains_text(table("-1,0.6\n"), "no triangle -1"));
    CHECK(contains_text(table("0,0.6\n0,0.6\n"), "listed twice"));
    CHECK(contains_text(table("0\n"), "1 columns"));
    CHECK(contains_text(table("0,thick\n"), "\"thick\""));
    CHECK(contains_text(table("x,0.6\n"), "\"x\" is not a triangle"));
    CHECK(contains_text(
        problem_of(folder.write("q.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n"), "t.csv"),
        "4 corners"));
    CHECK(
        contains_text(problem_of(folder.write("q.obj", "v 0 0 x\n"), "t.csv"), "\"x\" is not a coordinate"));
    CHECK(contains_text(problem_of(folder.write("q.obj", "v 0 0 0\nf 1 2 0\n"), "t.csv"),
                        "\"0\" is not a vertex"));
    const std::string bent = folder.write("q.obj", "v 0 0 0\nv 2 0 0\nv 2 2 1\nf 1 2 3\n");
    CHECK(contains_text(problem_of(bent, folder.write("t.csv", "0,0.6\n")), "not flat"));
}
