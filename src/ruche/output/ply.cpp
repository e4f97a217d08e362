#include <fmt/format.h>

#include "ruche/output/exporters.hpp"
#include "ruche/output/text_rows.hpp"

namespace ruche {
namespace {

const char* type_name(DataColumn::Kind kind) {
    switch (kind) {
        case DataColumn::Kind::float64:
            return "double";
        case DataColumn::Kind::float32:
            return "float";
        case DataColumn::Kind::int32:
            return "int";
    }
    return "";
}

std::string properties(const std::vector<DataColumn>& columns) {
    std::string text;
    for (const DataColumn& column : columns) {
        if (column.parts.empty())
            text += fmt::format("property {} {}\n", type_name(column.kind), column.name);
        for (const std::string& part : column.parts)
            text += fmt::format("property {} {}\n", type_name(column.kind), part);
    }
    return text;
}

/// A name as a header's line can hold it.
std::string one_line(const std::string& name) {
    constexpr std::size_t longest = 200;
    std::string text = name.substr(0, longest);
    for (char& c : text)
        if (static_cast<unsigned char>(c) < 0x20U) c = ' ';
    return text;
}

template <class Out>
void write_row(Out out, const std::vector<DataColumn>& columns, std::size_t row) {
    for (const DataColumn& column : columns) {
        const std::size_t count = column.components();
        for (std::size_t i = row * count; i < (row + 1) * count; ++i) {
            if (column.kind == DataColumn::Kind::float32)
                out = fmt::format_to(out, " {}", static_cast<float>(column.values[i]));
            else
                out = fmt::format_to(out, " {}", column.values[i]);
        }
    }
    fmt::format_to(out, "\n");
}

}  // namespace

// ASCII, because meshio (5.3) cannot read a binary PLY whose faces have properties besides their vertices.
std::string to_ply(const ExportSurface& surface) {
    std::string text = "ply\nformat ascii 1.0\n";
    text += "comment lengths in mm; curvature positive when the concave side is the back\n";
    text += "comment side: 0 bare fabric, 1 front, 2 back, 3 both; strip: -1 none\n";
    for (std::size_t i = 0; i < surface.strip_ids.size(); ++i)
        text += fmt::format("comment strip {} {}\n", i, one_line(surface.strip_ids[i]));
    text += fmt::format("element vertex {}\n", surface.positions.size());
    text += "property double x\nproperty double y\nproperty double z\n";
    text += "property float nx\nproperty float ny\nproperty float nz\n";
    text += properties(surface.vertex_data);
    text += fmt::format("element face {}\n", surface.triangles.size());
    text += "property list uchar int vertex_indices\n";
    text += properties(surface.face_data) + "end_header\n";
    append_rows(text, surface.positions.size(), [&](auto out, std::size_t v) {
        const Vec3& p = surface.positions[v];
        const Eigen::Vector3f n = surface.normals[v].cast<float>();
        out = fmt::format_to(out, "{} {} {} {} {} {}", p.x(), p.y(), p.z(), n.x(), n.y(), n.z());
        write_row(out, surface.vertex_data, v);
    });
    append_rows(text, surface.triangles.size(), [&](auto out, std::size_t t) {
        const auto [a, b, c] = surface.triangles[t];
        out = fmt::format_to(out, "3 {} {} {}", a, b, c);
        write_row(out, surface.face_data, t);
    });
    return text;
}

}  // namespace ruche
