#include <fmt/format.h>

#include "ruche/core/document.hpp"
#include "ruche/core/error.hpp"
#include "ruche/meshing/ply_file.hpp"
#include "ruche/meshing/raw_mesh.hpp"

namespace ruche {
namespace {

constexpr const char* advice =
    "A PLY for a layout has vertices x, y and triangles (vertex_indices) with the properties front_mm and "
    "back_mm: printed thickness, 0 for none.";

/// Where a value of a vertex or face goes; nullptr: nowhere.
double* vertex_target(Vec3& vertex, const std::string& name) {
    if (name == "x") return &vertex.x();
    if (name == "y") return &vertex.y();
    if (name == "z") return &vertex.z();
    return nullptr;
}

struct Face {
    Print print;
    double thickness = 0.0;
    double strip = -1.0;  // on whichever side is printed
    double front_strip = -1.0;
    double back_strip = -1.0;
    bool has_corners = false;
    Triangle corners = {};
};

double* face_target(Face& face, const std::string& name) {
    if (name == "front_mm") return &face.print.front;
    if (name == "back_mm") return &face.print.back;
    if (name == "thickness_mm") return &face.thickness;
    if (name == "strip") return &face.strip;
    if (name == "front_strip") return &face.front_strip;
    if (name == "back_strip") return &face.back_strip;
    if (name == "front_modulus_mpa") return &face.print.front_modulus;
    if (name == "back_modulus_mpa") return &face.print.back_modulus;
    return nullptr;
}

void read_list(PlyBody& body, const PlyProperty& property, Face* face) {
    const int count = body.take_count(property);
    const bool corners =
        face != nullptr && (property.name == "vertex_indices" || property.name == "vertex_index");
    if (corners && count != 3)
        body.fail(fmt::format("a face with {} corners; a layout mesh has triangles only", count));
    for (int i = 0; i < count; ++i) {
        const double value = body.take(property.type);
        if (corners) face->corners[i] = ply_index(value);
    }
    if (corners) face->has_corners = true;
}

bool has_property(const PlyHeader& header, std::string_view element, std::string_view property) {
    for (const PlyElement& e : header.elements) {
        for (const PlyProperty& p : e.properties) {
            if (e.name == element && p.name == property) return true;
        }
    }
    return false;
}

void check_properties(const PlyHeader& header, const std::string& file) {
    const auto has = [&](const char* element, const char* property) {
        return has_property(header, element, property);
    };
    const auto fail = [&](const char* problem) { throw InputError({.file = file}, problem, advice); };
    if (!has("vertex", "x") || !has("vertex", "y")) fail("the vertices have no x and y");
    if (!has("face", "vertex_indices") && !has("face", "vertex_index")) fail("there are no faces");
    const bool sides = has("face", "front_mm") || has("face", "back_mm");
    const bool is_signed = has("face", "thickness_mm");
    if (sides && is_signed) fail("the faces have both thickness_mm and front_mm or back_mm");
    if (!sides && !is_signed) fail("the faces have neither front_mm, back_mm nor thickness_mm");
}

}  // namespace

RawMesh read_ply(const std::string& path) {
    const std::string text = read_file(path, "PLY mesh", largest_mesh_file);
    TextScan scan(text);
    const PlyHeader header = read_ply_header(scan, path, advice);
    check_properties(header, path);
    PlyBody body(scan, header.format, path, advice);
    RawMesh mesh;
    mesh.strip_names = header.strip_names;
    const bool strip_per_side =
        has_property(header, "face", "front_strip") || has_property(header, "face", "back_strip");
    for (const PlyElement& element : header.elements) {
        const bool vertices = element.name == "vertex";
        const bool faces = element.name == "face";
        for (std::int64_t i = 0; i < element.count; ++i) {
            body.begin_item(element, i);
            Vec3 vertex = Vec3::Zero();
            Face face;
            for (const PlyProperty& property : element.properties) {
                if (property.count_type) {
                    read_list(body, property, faces ? &face : nullptr);
                    continue;
                }
                const double value = body.take(property.type);
                double* target = vertices ? vertex_target(vertex, property.name)
                                 : faces  ? face_target(face, property.name)
                                          : nullptr;
                if (target != nullptr) *target = value;
            }
            if (vertices) mesh.vertices.push_back(vertex);
            if (!faces) continue;
            if (face.thickness < 0.0)
                face.print.back = -face.thickness;
            else if (face.thickness > 0.0 || face.thickness != face.thickness)
                face.print.front = face.thickness;
            mesh.triangles.push_back(face.corners);
            mesh.print.push_back(face.print);
            mesh.strip.push_back({ply_index(strip_per_side ? face.front_strip : face.strip),
                                  ply_index(strip_per_side ? face.back_strip : face.strip)});
        }
    }
    return mesh;
}

}  // namespace ruche
