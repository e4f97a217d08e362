#include <fmt/format.h>

#include <cstdint>

#include "ruche/core/document.hpp"
#include "ruche/core/error.hpp"
#include "ruche/core/text_scan.hpp"
#include "ruche/meshing/raw_mesh.hpp"

namespace ruche {
namespace {

constexpr const char* obj_advice = "A mesh as OBJ has lines \"v x y z\" and triangles \"f a b c\".";
constexpr const char* table_advice =
    "The table has the columns triangle (in the OBJ's order, from 0), front_mm and back_mm: printed "
    "thickness, "
    "0 for none. Numbers have a decimal point.";

/// "7", "7/1", "7//3", "-1": the vertex, from 0; -1 where it is no vertex.
int vertex_of(std::string_view corner, std::size_t vertices) {
    std::int64_t number = 0;
    if (!read_number(corner.substr(0, corner.find('/')), number)) return -1;
    if (number < 0) number += static_cast<std::int64_t>(vertices) + 1;
    return number >= 1 && number <= 2'000'000'000 ? static_cast<int>(number - 1) : -1;
}

class ObjReader {
  public:
    enum class Faces { triangles, polygons };

    ObjReader(const std::string& path, Faces faces) : path_(path), faces_(faces) {}

    RawMesh read() {
        const std::string text = read_file(path_, "OBJ mesh", largest_mesh_file);
        if (text.find('\0') != std::string::npos)
            throw InputError({.file = path_}, "this is not a text file", obj_advice);
        TextScan scan(text);
        while (!scan.at_end()) {
            std::string_view line = scan.take_line();
            line_ = scan.line();
            const std::string_view word = take_word(line);
            if (word == "v") read_vertex(line);
            if (word == "f") read_face(line);
        }
        mesh_.print.resize(mesh_.triangles.size());
        return std::move(mesh_);
    }

  private:
    void read_vertex(std::string_view line) {
        Vec3 x = Vec3::Zero();
        for (int k = 0; k < 3; ++k) {
            const std::string_view word = take_word(line);
            if (word.empty() && k == 2) break;
            if (!read_number(word, x[k])) fail(fmt::format("\"{}\" is not a coordinate", word.substr(0, 40)));
        }
        mesh_.vertices.push_back(x);
    }

    void read_face(std::string_view line) {
        std::vector<int> corners;
        for (std::string_view word = take_word(line); !word.empty(); word = take_word(line)) {
            if (word.starts_with('#')) break;
            const int vertex = vertex_of(word, mesh_.vertices.size());
            if (vertex < 0) fail(fmt::format("\"{}\" is not a vertex", word.substr(0, 40)));
            corners.push_back(vertex);
        }
        if (faces_ == Faces::triangles && corners.size() != 3)
            fail(fmt::format("a face with {} corners; a layout mesh has triangles only", corners.size()));
        append_fan(mesh_, corners);
    }

    [[noreturn]] void fail(const std::string& problem) const {
        throw InputError({.file = path_, .line = line_}, problem, obj_advice);
    }

    const std::string& path_;
    Faces faces_;
    int line_ = 0;
    RawMesh mesh_;
};

/// Cuts a line of a table at commas, semicolons, tabs or blanks.
std::vector<std::string_view> cells_of(std::string_view line) {
    std::vector<std::string_view> cells;
    line = line.substr(0, line.find('#'));
    while (true) {
        const auto begin = line.find_first_not_of(" \t,;\"");
        if (begin == std::string_view::npos) return cells;
        const auto end = std::min(line.find_first_of(" \t,;\"", begin), line.size());
        cells.push_back(line.substr(begin, end - begin));
        line.remove_prefix(end);
    }
}

void read_thickness(const std::string& path, RawMesh& mesh) {
    const std::string text = read_file(path, "table of thicknesses", largest_mesh_file);
    std::string_view rest = text;
    if (rest.starts_with("\xEF\xBB\xBF")) rest.remove_prefix(3);
    TextScan scan(rest);
    std::vector<char> listed(mesh.triangles.size(), 0);
    bool first = true;
    while (!scan.at_end()) {
        const std::vector<std::string_view> cells = cells_of(scan.take_line());
        if (cells.empty()) continue;
        const auto fail = [&](const std::string& problem) {
            throw InputError({.file = path, .line = scan.line()}, problem, table_advice);
        };
        const bool header = first && cells.front() == "triangle";
        first = false;
        if (header) continue;
        if (cells.size() < 2 || cells.size() > 3)
            fail(fmt::format("{} columns, expected 2 or 3", cells.size()));
        std::int64_t triangle = 0;
        if (!read_number(cells[0], triangle))
            fail(fmt::format("\"{}\" is not a triangle", cells[0].substr(0, 40)));
        if (triangle < 0 || triangle >= static_cast<std::int64_t>(listed.size()))
            fail(fmt::format("there is no triangle {}: the mesh has 0 to {}", triangle,
                             static_cast<std::int64_t>(listed.size()) - 1));
        if (listed[triangle]) fail(fmt::format("triangle {} is listed twice", triangle));
        listed[triangle] = 1;
        Print& print = mesh.print[triangle];
        for (std::size_t k = 1; k < cells.size(); ++k) {
            if (!read_number(cells[k], k == 1 ? print.front : print.back))
                fail(fmt::format("\"{}\" is not a thickness", cells[k].substr(0, 40)));
        }
    }
}

}  // namespace

RawMesh read_obj_surface(const std::string& path) {
    return ObjReader(path, ObjReader::Faces::polygons).read();
}

RawMesh read_obj(const std::string& path, const std::string& thickness_table) {
    RawMesh mesh = ObjReader(path, ObjReader::Faces::triangles).read();
    if (thickness_table.empty())
        throw InputError({.file = path}, "an OBJ says nothing about what is printed",
                         std::string("Name a CSV file as pattern.thickness_table. ") + table_advice);
    read_thickness(thickness_table, mesh);
    return mesh;
}

}  // namespace ruche
