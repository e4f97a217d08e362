#include "ruche/output/export_surface.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <stdexcept>

namespace ruche {
namespace {

using Kind = DataColumn::Kind;

/// One column from a list of things and a function that takes a number from each.
template <class List, class Get>
DataColumn column(std::string name, Kind kind, const List& list, const Get& get) {
    DataColumn result{.name = std::move(name), .kind = kind};
    result.values.reserve(list.size());
    for (const auto& item : list) result.values.push_back(static_cast<double>(get(item)));
    return result;
}

template <class Vector>
DataColumn vector_column(std::string name, std::vector<std::string> parts, Kind kind,
                         const std::vector<Vector>& list) {
    DataColumn result{.name = std::move(name), .parts = std::move(parts), .kind = kind};
    for (const Vector& item : list)
        for (int i = 0; i < static_cast<int>(item.size()); ++i) result.values.push_back(item[i]);
    return result;
}

void add_curvature(std::vector<DataColumn>& data, const std::vector<VertexCurvature>& curvature) {
    const auto add = [&](const char* name, const auto& get) {
        data.push_back(column(name, Kind::float32, curvature, get));
    };
    add("curvature_max_per_mm", [](const VertexCurvature& c) { return c.max; });
    add("curvature_min_per_mm", [](const VertexCurvature& c) { return c.min; });
    add("mean_curvature_per_mm", [](const VertexCurvature& c) { return c.mean(); });
    add("gauss_curvature_per_mm2", [](const VertexCurvature& c) { return c.gauss(); });
}

std::vector<DataColumn> face_columns(const SurfaceFields& fields) {
    const auto same = [](double value) { return value; };
    std::vector<DataColumn> data;
    data.push_back(column("front_mm", Kind::float64, fields.front_mm, same));
    data.push_back(column("back_mm", Kind::float64, fields.back_mm, same));
    if (!fields.front_modulus_mpa.empty()) {
        data.push_back(column("front_modulus_mpa", Kind::float64, fields.front_modulus_mpa, same));
        data.push_back(column("back_modulus_mpa", Kind::float64, fields.back_modulus_mpa, same));
    }
    data.push_back(
        column("side", Kind::int32, fields.side, [](PrintedSide side) { return static_cast<int>(side); }));
    data.push_back(column("strip", Kind::int32, fields.strip, [](int strip) { return strip; }));
    data.push_back(
        column("front_strip", Kind::int32, fields.strips, [](const StripPair& pair) { return pair.front; }));
    data.push_back(
        column("back_strip", Kind::int32, fields.strips, [](const StripPair& pair) { return pair.back; }));
    add_curvature(data, fields.face_curvature);
    data.push_back(column("stretch_max", Kind::float32, fields.stretch_max, same));
    data.push_back(column("stretch_min", Kind::float32, fields.stretch_min, same));
    data.push_back(column("self_intersecting", Kind::int32, fields.passes_through, same));
    if (!fields.energy_density.empty())
        data.push_back(column("energy_density_mJ_per_mm2", Kind::float32, fields.energy_density, same));
    return data;
}

ExportSurface common(const Result& result, const SurfaceFields& fields) {
    ExportSurface surface;
    surface.title = result_title(result);
    surface.layout = result.layout.mesh.vertices;
    surface.triangles = result.layout.mesh.triangles;
    surface.strip = fields.strip;
    surface.side = fields.side;
    for (const MeshedStrip& strip : result.layout.strips) surface.strip_ids.push_back(strip.id);
    add_curvature(surface.vertex_data, fields.vertex_curvature);
    surface.vertex_data.push_back(
        vector_column("layout_mm", {"layout_x", "layout_y"}, Kind::float64, surface.layout));
    surface.face_data = face_columns(fields);
    return surface;
}

}  // namespace

ExportSurface released_surface(const Result& result, const SurfaceFields& fields) {
    for (std::size_t v = 0; v < result.shape.size(); ++v)
        if (!result.shape[v].allFinite())
            throw std::runtime_error(fmt::format(
                "the shape cannot be exported: the position of vertex {} is not a finite number", v));
    ExportSurface surface = common(result, fields);
    surface.positions = result.shape;
    surface.normals = fields.vertex_normal;
    surface.face_data.push_back(
        vector_column("normal", {"nx", "ny", "nz"}, Kind::float32, fields.face_normal));
    return surface;
}

ExportSurface layout_surface(const Result& result, const SurfaceFields& fields) {
    ExportSurface surface = common(result, fields);
    surface.title += " layout";
    for (const Vec2& v : surface.layout) surface.positions.emplace_back(v.x(), v.y(), 0.0);
    surface.normals.assign(surface.positions.size(), Vec3::UnitZ());
    return surface;
}

std::string result_title(const Result& result) {
    const PatternSource& pattern = result.scene.pattern;
    for (const std::string& file : {result.scene.file, pattern.svg, pattern.mesh}) {
        const std::filesystem::path path(file);
        // kite/scene.toml is about a kite.
        const std::string stem = path.stem() == "scene" && path.has_parent_path()
                                     ? path.parent_path().filename().string()
                                     : path.stem().string();
        if (!stem.empty()) return stem;
    }
    return pattern.generator.empty() ? "untitled" : pattern.generator;
}

}  // namespace ruche
