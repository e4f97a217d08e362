#include <doctest/doctest.h>

#include <bit>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "ruche/core/error.hpp"
#include "ruche/meshing/raw_mesh.hpp"

using namespace ruche;

namespace {

class ScanFolder {
  public:
    ScanFolder()
        : path_(std::filesystem::temp_directory_path() / ("ruche-surface-" + std::to_string(getpid()))) {
        std::filesystem::create_directories(path_);
    }
    ~ScanFolder() { std::filesystem::remove_all(path_); }

    std::string write(const std::string& name, const std::string& bytes) const {
        std::ofstream(path_ / name, std::ios::binary) << bytes;
        return (path_ / name).string();
    }

  private:
    std::filesystem::path path_;
};

/// A fan of ten quads around z = 1: 22 points.
std::vector<Vec3> points() {
    std::vector<Vec3> list;
    for (int i = 0; i < 11; ++i)
        for (int k = 0; k < 2; ++k) list.emplace_back(i, k, 1.0 + 0.1 * i);
    return list;
}

template <class Number>
std::string raw(Number value) {
    std::string bytes(sizeof(Number), '\0');
    std::memcpy(bytes.data(), &value, sizeof(Number));
    return bytes;
}

std::string obj() {
    std::string text = "# a scan\n";
    for (const Vec3& p : points())
        text += "v " + std::to_string(p.x()) + " " + std::to_string(p.y()) + " " + std::to_string(p.z()) +
                " 0.5 0.5 0.5\n";
    for (int i = 0; i < 10; ++i) {
        const int a = 2 * i + 1;
        text += "f " + std::to_string(a) + "//1 " + std::to_string(a + 2) + "//1 " + std::to_string(a + 3) +
                " " + std::to_string(a + 1) + "\n";
    }
    return text;
}

std::string binary_stl() {
    std::string bytes = "solid, although it is binary";
    bytes.resize(80, ' ');
    bytes += raw<std::uint32_t>(20);
    const std::vector<Vec3> p = points();
    for (int i = 0; i < 10; ++i)
        for (const auto& [a, b, c] : {std::array{0, 2, 3}, std::array{0, 3, 1}}) {
            bytes += raw(0.0F) + raw(0.0F) + raw(1.0F);
            for (const int k : {a, b, c})
                for (const double x : p[static_cast<std::size_t>(2 * i + k)])
                    bytes += raw(static_cast<float>(x));
            bytes += raw<std::uint16_t>(0);
        }
    return bytes;
}

double area(const RawMesh& mesh) {
    double sum = 0.0;
    for (const auto& [a, b, c] : mesh.triangles) {
        const Vec3 u =
            mesh.vertices[static_cast<std::size_t>(b)] - mesh.vertices[static_cast<std::size_t>(a)];
        const Vec3 v =
            mesh.vertices[static_cast<std::size_t>(c)] - mesh.vertices[static_cast<std::size_t>(a)];
        sum += 0.5 * Vec3(u.y() * v.z() - u.z() * v.y(), u.z() * v.x() - u.x() * v.z(),
                          u.x() * v.y() - u.y() * v.x())
                         .norm();
    }
    return sum;
}

const double right_area = 10.0 * std::hypot(1.0, 0.1);

}  // namespace

TEST_CASE("scan: OBJ with colours, texture numbers and quads") {
    const ScanFolder folder;
    const RawMesh mesh = read_surface(folder.write("a.OBJ", obj()));
    CHECK(mesh.vertices.size() == 22);
    CHECK(mesh.triangles.size() == 20);
    CHECK(area(mesh) == doctest::Approx(right_area).epsilon(1e-6));
}

TEST_CASE("scan: binary STL whose header says solid, and STL as text") {
    const ScanFolder folder;
    const RawMesh binary = read_surface(folder.write("a.stl", binary_stl()));
    CHECK(binary.triangles.size() == 20);
    CHECK(area(binary) == doctest::Approx(right_area).epsilon(1e-6));
    std::string text = "solid x\n";
    for (const auto& triangle : binary.triangles) {
        text += "facet normal 0 0 1\n outer loop\n";
        for (const int v : triangle) {
            const Vec3& p = binary.vertices[static_cast<std::size_t>(v)];
            text += "  vertex " + std::to_string(p.x()) + " " + std::to_string(p.y()) + " " +
                    std::to_string(p.z()) + "\n";
        }
        text += " endloop\nendfacet\n";
    }
    CHECK(area(read_surface(folder.write("b.stl", text + "endsolid\n"))) ==
          doctest::Approx(right_area).epsilon(1e-5));
}

TEST_CASE("scan: PLY in binary of both byte orders, with quads and colours, and points alone") {
    const ScanFolder folder;
    for (const bool big : {false, true}) {
        const auto number = [&](auto value) {
            std::string bytes = raw(value);
            if (big) std::reverse(bytes.begin(), bytes.end());
            return bytes;
        };
        std::string head = std::string("ply\nformat binary_") + (big ? "big" : "little") +
                           "_endian 1.0\nelement vertex 22\n" +
                           "property float x\nproperty float y\nproperty float z\nproperty uchar red\n";
        std::string body;
        for (const Vec3& p : points()) {
            for (const double x : p) body += number(static_cast<float>(x));
            body += '\x7f';
        }
        CHECK(read_surface(folder.write("points.ply", head + "end_header\n" + body)).triangles.empty());
        for (int i = 0; i < 10; ++i) {
            body += '\x04';
            for (const int k : {0, 2, 3, 1}) body += number(2 * i + k);
        }
        head += "element face 10\nproperty list uchar int vertex_indices\nend_header\n";
        CHECK(area(read_surface(folder.write("quads.ply", head + body))) ==
              doctest::Approx(right_area).epsilon(1e-6));
    }
}

TEST_CASE("scan: what is none is refused with the file's name") {
    const ScanFolder folder;
    const std::string stl = binary_stl();
    const std::pair<const char*, std::string> bad[] = {
        {"a.stl", stl.substr(0, stl.size() - 7)},
        {"b.stl", "no solid at all"},
        {"c.stl", ""},
        {"d.obj", "v 1 2 three\n"},
        {"e.obj", obj() + "f 1 2 900\n"},
        {"f.obj", "v 1 2 3\n"},
        {"g.ply", "ply\nformat ascii 1.0\nelement vertex 20\nproperty float x\nend_header\n1\n"},
        {"h.ply", "plyformat"},
        {"i.xyz", "1 2 3"},
        {"j.obj", obj() + "v nan 0 0\n"},
    };
    for (const auto& [name, bytes] : bad) {
        const std::string path = folder.write(name, bytes);
        CAPTURE(name);
        CHECK_THROWS_WITH_AS((void)read_surface(path), doctest::Contains(name), InputError);
    }
}
