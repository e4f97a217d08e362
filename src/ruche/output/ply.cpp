#include <fmt/format.h>

#include "ruche/output/exporters.hpp"
#include "ruche/output/little_endian.hpp"

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

void append_row(std::string& out, const std::vector<DataColumn>& columns, std::size_t row) {
    for (const DataColumn& column : columns) {
        const std::size_t count = column.components();
        for (std::size_t i = row * count; i < (row + 1) * count; ++i) {
            switch (column.kind) {
                case DataColumn::Kind::float64:
                    append_bytes(out, column.values[i]);
                    break;
                case DataColumn::Kind::float32:
                    append_bytes(out, static_cast<float>(column.values[i]));
                    break;
                case DataColumn::Kind::int32:
                    append_bytes(out, static_cast<int>(column.values[i]));
                    break;
            }
        }
    }
}

}  // namespace

std::string to_ply(const ExportSurface& surface) {
    std::string out = "ply\nformat binary_little_endian 1.0\n";
    out += "comment lengths in mm; curvature positive when the concave side is the back\n";
    out += "comment side: 0 bare fabric, 1 front, 2 back, 3 both; strip: -1 none\n";
    out += fmt::format("element vertex {}\n", surface.positions.size());
    out += "property double x\nproperty double y\nproperty double z\n";
    out += "property float nx\nproperty float ny\nproperty float nz\n";
    out += properties(surface.vertex_data);
    out += fmt::format("element face {}\n", surface.triangles.size());
    out += "property list uchar int vertex_indices\n";
    out += properties(surface.face_data) + "end_header\n";
    for (std::size_t v = 0; v < surface.positions.size(); ++v) {
        for (int i = 0; i < 3; ++i) append_bytes(out, surface.positions[v][i]);
        for (int i = 0; i < 3; ++i) append_bytes(out, static_cast<float>(surface.normals[v][i]));
        append_row(out, surface.vertex_data, v);
    }
    for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
        append_bytes(out, static_cast<unsigned char>(3));
        for (const int v : surface.triangles[t]) append_bytes(out, v);
        append_row(out, surface.face_data, t);
    }
    return out;
}

}  // namespace ruche
