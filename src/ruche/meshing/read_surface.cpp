#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>

#include "ruche/core/document.hpp"
#include "ruche/core/error.hpp"
#include "ruche/core/text_scan.hpp"
#include "ruche/meshing/ply_file.hpp"
#include "ruche/meshing/raw_mesh.hpp"

namespace ruche {
namespace {

constexpr std::size_t largest_scan_file = std::size_t{1} << 31U;

RawMesh read_ply_surface(const std::string& path) {
    constexpr const char* advice = "A scan as PLY has vertices x, y, z and, mostly, faces (vertex_indices).";
    const std::string text = read_file(path, "PLY scan", largest_scan_file);
    TextScan scan(text);
    const PlyHeader header = read_ply_header(scan, path, advice);
    PlyBody body(scan, header.format, path, advice);
    RawMesh mesh;
    std::vector<int> corners;
    for (const PlyElement& element : header.elements) {
        const bool vertices = element.name == "vertex";
        for (std::int64_t i = 0; i < element.count; ++i) {
            body.begin_item(element, i);
            Vec3 vertex = Vec3::Zero();
            for (const PlyProperty& property : element.properties) {
                if (property.count_type) {
                    corners.clear();
                    const int count = body.take_count(property);
                    for (int k = 0; k < count; ++k) corners.push_back(ply_index(body.take(property.type)));
                    const bool face = property.name == "vertex_indices" || property.name == "vertex_index";
                    if (face && element.name == "face") append_fan(mesh, corners);
                    continue;
                }
                const double value = body.take(property.type);
                if (property.name == "x") vertex.x() = value;
                if (property.name == "y") vertex.y() = value;
                if (property.name == "z") vertex.z() = value;
            }
            if (vertices) mesh.vertices.push_back(vertex);
        }
    }
    return mesh;
}

/// Binary STL: 80 bytes of anything, the number of triangles, 50 bytes each: normal, corners, two more.
constexpr std::size_t stl_head = 84;
constexpr std::size_t stl_triangle = 50;

std::uint32_t stl_count(const std::string& bytes) {
    std::uint32_t count = 0;
    std::memcpy(&count, bytes.data() + stl_head - sizeof(count), sizeof(count));
    return count;
}

/// By its length: text files may begin with anything, and binary ones with "solid", too.
bool is_binary_stl(const std::string& bytes) {
    return bytes.size() >= stl_head &&
           bytes.size() == stl_head + stl_triangle * std::size_t{stl_count(bytes)};
}

RawMesh read_binary_stl(const std::string& bytes) {
    RawMesh mesh;
    for (std::uint32_t t = 0; t < stl_count(bytes); ++t) {
        std::array<float, 9> corner;
        std::memcpy(corner.data(), bytes.data() + stl_head + stl_triangle * t + 3 * sizeof(float),
                    sizeof(corner));
        const int first = static_cast<int>(mesh.vertices.size());
        for (int k = 0; k < 3; ++k)
            mesh.vertices.emplace_back(corner[3 * k], corner[3 * k + 1], corner[3 * k + 2]);
        mesh.triangles.push_back({first, first + 1, first + 2});
    }
    return mesh;
}

RawMesh read_text_stl(const std::string& text, const std::string& path) {
    RawMesh mesh;
    TextScan scan(text);
    const auto fail = [&](const std::string& problem) {
        throw InputError(
            {.file = path, .line = scan.line()}, problem,
            "An STL is binary (84 bytes and 50 for each triangle), or text with lines \"vertex x y z\".");
    };
    while (!scan.at_end()) {
        std::string_view line = scan.take_line();
        const std::string_view word = take_word(line);
        if (scan.line() == 1 && word != "solid")
            fail("this is no STL file: it is neither binary nor begins with \"solid\"");
        if (word != "vertex") continue;
        Vec3 vertex;
        for (double& coordinate : vertex) {
            const std::string_view number = take_word(line);
            if (!read_number(number, coordinate))
                fail(fmt::format("\"{}\" is not a coordinate", number.substr(0, 40)));
        }
        mesh.vertices.push_back(vertex);
        const int count = static_cast<int>(mesh.vertices.size());
        if (count % 3 == 0) mesh.triangles.push_back({count - 3, count - 2, count - 1});
    }
    if (mesh.vertices.size() % 3 != 0) fail("the last triangle is not complete");
    return mesh;
}

void check(const RawMesh& mesh, const std::string& path) {
    constexpr std::size_t fewest = 10;
    if (mesh.vertices.size() < fewest)
        throw InputError({.file = path},
                         fmt::format("has {} points, a scan has thousands", mesh.vertices.size()));
    for (const Vec3& vertex : mesh.vertices)
        if (!vertex.allFinite()) throw InputError({.file = path}, "has a coordinate that is no number");
    for (const Triangle& triangle : mesh.triangles)
        for (const int corner : triangle)
            if (corner < 0 || corner >= static_cast<int>(mesh.vertices.size()))
                throw InputError({.file = path}, fmt::format("a face names vertex {}, there are {}", corner,
                                                             mesh.vertices.size()));
}

}  // namespace

void append_fan(RawMesh& mesh, const std::vector<int>& corners) {
    for (std::size_t k = 2; k < corners.size(); ++k)
        mesh.triangles.push_back({corners[0], corners[k - 1], corners[k]});
}

RawMesh read_surface(const std::string& path) {
    std::string ending = std::filesystem::path(path).extension().string();
    for (char& c : ending)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    RawMesh mesh;
    if (ending == ".ply") {
        mesh = read_ply_surface(path);
    } else if (ending == ".obj") {
        mesh = read_obj_surface(path);
    } else if (ending == ".stl") {
        const std::string bytes = read_file(path, "STL scan", largest_scan_file);
        mesh = is_binary_stl(bytes) ? read_binary_stl(bytes) : read_text_stl(bytes, path);
    } else {
        throw InputError({.file = path}, "is neither OBJ, PLY nor STL",
                         "Every scanner's program can save one of these.");
    }
    check(mesh, path);
    return mesh;
}

}  // namespace ruche
