#include <fmt/format.h>

#include "ruche/output/exporters.hpp"
#include "ruche/output/little_endian.hpp"

namespace ruche {
namespace {

std::string base64(const std::string& bytes) {
    constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    out.reserve((bytes.size() + 2) / 3 * 4);
    const auto at = [&](std::size_t i) -> unsigned {
        return i < bytes.size() ? static_cast<unsigned char>(bytes[i]) : 0U;
    };
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const unsigned group = at(i) << 16U | at(i + 1) << 8U | at(i + 2);
        for (int k = 0; k < 4; ++k)
            out += i + k <= bytes.size() ? digits[group >> (18U - 6U * k) & 63U] : '=';
    }
    return out;
}

/// The bytes of an array as VTK's inline binary arrays want them: their number first.
class Array {
  public:
    template <class Number>
    void add(Number value) {
        append_bytes(bytes_, value);
    }
    std::string encoded() const {
        std::string whole;
        append_bytes(whole, static_cast<std::uint64_t>(bytes_.size()));
        return base64(whole + bytes_);
    }

  private:
    std::string bytes_;
};

std::string data_array(const char* type, const std::string& name, int components, const Array& array) {
    const std::string shape = components == 1 ? "" : fmt::format(" NumberOfComponents=\"{}\"", components);
    return fmt::format("<DataArray type=\"{}\" Name=\"{}\"{} format=\"binary\">{}</DataArray>\n", type, name,
                       shape, array.encoded());
}

std::string data_array(const DataColumn& column) {
    Array array;
    const char* type = "";
    // VTK takes a vector to have three components.
    const int components = column.components() == 2 ? 3 : column.components();
    for (std::size_t i = 0; i < column.values.size(); ++i) {
        const auto add = [&](auto value) {
            array.add(value);
            if (column.components() == 2 && i % 2 == 1) array.add(decltype(value){0});
        };
        switch (column.kind) {
            case DataColumn::Kind::float64:
                add(column.values[i]);
                break;
            case DataColumn::Kind::float32:
                add(static_cast<float>(column.values[i]));
                break;
            case DataColumn::Kind::int32:
                add(static_cast<std::int32_t>(column.values[i]));
                break;
        }
    }
    switch (column.kind) {
        case DataColumn::Kind::float64:
            type = "Float64";
            break;
        case DataColumn::Kind::float32:
            type = "Float32";
            break;
        case DataColumn::Kind::int32:
            type = "Int32";
            break;
    }
    return data_array(type, column.name, components, array);
}

}  // namespace

std::string to_vtu(const ExportSurface& surface) {
    Array points, connectivity, offsets, types, normals;
    for (const Vec3& p : surface.positions)
        for (int i = 0; i < 3; ++i) points.add(p[i]);
    for (const Vec3& n : surface.normals)
        for (int i = 0; i < 3; ++i) normals.add(static_cast<float>(n[i]));
    for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
        for (const int v : surface.triangles[t]) connectivity.add(static_cast<std::int64_t>(v));
        offsets.add(static_cast<std::int64_t>(3 * (t + 1)));
        types.add(static_cast<unsigned char>(5));  // VTK_TRIANGLE
    }
    std::string out =
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" "
        "byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<UnstructuredGrid>\n";
    out += fmt::format("<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n", surface.positions.size(),
                       surface.triangles.size());
    out += "<Points>\n" + data_array("Float64", "Points", 3, points) + "</Points>\n<Cells>\n";
    out += data_array("Int64", "connectivity", 1, connectivity) + data_array("Int64", "offsets", 1, offsets) +
           data_array("UInt8", "types", 1, types) + "</Cells>\n<PointData>\n";
    out += data_array("Float32", "normal", 3, normals);
    for (const DataColumn& column : surface.vertex_data) out += data_array(column);
    out += "</PointData>\n<CellData>\n";
    for (const DataColumn& column : surface.face_data) out += data_array(column);
    out += "</CellData>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
    return out;
}

}  // namespace ruche
