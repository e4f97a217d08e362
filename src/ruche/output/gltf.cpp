#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>

#include "ruche/output/curvature.hpp"
#include "ruche/output/exporters.hpp"
#include "ruche/output/little_endian.hpp"
#include "ruche/output/palette.hpp"
#include "ruche/output/relief.hpp"

namespace ruche {
namespace {

using Json = nlohmann::ordered_json;

// Enumerations of the glTF 2.0 specification.
constexpr int component_float = 5126;
constexpr int component_uint32 = 5125;
constexpr int target_vertices = 34962;
constexpr int target_indices = 34963;

/// Collects meshes into the two halves of a GLB file: the JSON and the binary buffer.
class GlbBuilder {
  public:
    int add_material(const char* name, const Colour& colour, double roughness) {
        const auto rgb = colour.linear();
        json_["materials"].push_back({{"name", name},
                                      {"doubleSided", true},
                                      {"pbrMetallicRoughness",
                                       {{"baseColorFactor", {rgb[0], rgb[1], rgb[2], 1.0}},
                                        {"metallicFactor", 0.0},
                                        {"roughnessFactor", roughness}}}});
        return static_cast<int>(json_["materials"].size()) - 1;
    }

    void add_mesh(const char* name, const Relief& relief, int material) {
        if (relief.triangles.empty()) return;
        const int position = add_vectors(relief.positions, 1e-3, true);
        const int normal = add_vectors(relief.normals, 1.0, false);
        Json primitive = {{"attributes", {{"POSITION", position}, {"NORMAL", normal}}},
                          {"indices", add_indices(relief.triangles)},
                          {"material", material}};
        json_["meshes"].push_back({{"name", name}, {"primitives", Json::array({primitive})}});
        const int mesh = static_cast<int>(json_["meshes"].size()) - 1;
        json_["nodes"].push_back({{"name", name}, {"mesh", mesh}});
    }

    std::string file(const std::string& title) {
        json_["asset"] = {{"version", "2.0"}, {"generator", "Ruche " RUCHE_VERSION}};
        Json nodes = Json::array();
        for (std::size_t i = 0; i < json_["nodes"].size(); ++i) nodes.push_back(i);
        json_["scenes"] = Json::array({{{"name", title}, {"nodes", nodes}}});
        json_["scene"] = 0;
        json_["buffers"] = Json::array({{{"byteLength", buffer_.size()}}});
        // A title may come from a file name in any encoding.
        std::string text = json_.dump(-1, ' ', false, Json::error_handler_t::replace);
        text.resize((text.size() + 3) / 4 * 4, ' ');
        std::string out = "glTF";
        append_bytes(out, std::uint32_t{2});
        append_bytes(out, static_cast<std::uint32_t>(12 + 8 + text.size() + 8 + buffer_.size()));
        append_bytes(out, static_cast<std::uint32_t>(text.size()));
        out += "JSON" + text;
        append_bytes(out, static_cast<std::uint32_t>(buffer_.size()));
        out.append("BIN\0", 4);
        return out + buffer_;
    }

  private:
    int add_view(std::size_t begin, int target) {
        json_["bufferViews"].push_back({{"buffer", 0},
                                        {"byteOffset", begin},
                                        {"byteLength", buffer_.size() - begin},
                                        {"target", target}});
        return static_cast<int>(json_["bufferViews"].size()) - 1;
    }

    int add_vectors(const std::vector<Vec3>& list, double scale, bool with_bounds) {
        const std::size_t begin = buffer_.size();
        std::array<float, 3> low, high;
        low.fill(std::numeric_limits<float>::max());
        high.fill(std::numeric_limits<float>::lowest());
        for (const Vec3& v : list) {
            const Vec3 y_up = scale * Vec3(v.x(), v.z(), -v.y());
            for (int i = 0; i < 3; ++i) {
                const auto value = static_cast<float>(y_up[i]);
                low[i] = std::min(low[i], value);
                high[i] = std::max(high[i], value);
                append_bytes(buffer_, value);
            }
        }
        Json accessor = {{"bufferView", add_view(begin, target_vertices)},
                         {"componentType", component_float},
                         {"count", list.size()},
                         {"type", "VEC3"}};
        if (with_bounds) {
            accessor["min"] = low;
            accessor["max"] = high;
        }
        return add_accessor(std::move(accessor));
    }

    int add_indices(const std::vector<Triangle>& triangles) {
        const std::size_t begin = buffer_.size();
        for (const Triangle& t : triangles)
            for (const int v : t) append_bytes(buffer_, static_cast<std::uint32_t>(v));
        return add_accessor({{"bufferView", add_view(begin, target_indices)},
                             {"componentType", component_uint32},
                             {"count", 3 * triangles.size()},
                             {"type", "SCALAR"}});
    }

    int add_accessor(Json accessor) {
        json_["accessors"].push_back(std::move(accessor));
        return static_cast<int>(json_["accessors"].size()) - 1;
    }

    Json json_;
    std::string buffer_;
};

}  // namespace

std::string to_glb(const Result& result) {
    const TriangleMesh& mesh = result.layout.mesh;
    std::vector<double> front(mesh.triangles.size(), 0.0), back(mesh.triangles.size(), 0.0);
    for (std::size_t t = 0; t < result.layout.print.size(); ++t) {
        front[t] = result.layout.print[t].front;
        back[t] = result.layout.print[t].back;
    }
    const auto rounding = [](const std::vector<double>& height) {
        return 0.25 * *std::max_element(height.begin(), height.end());
    };
    GlbBuilder glb;
    const int fabric = glb.add_material("fabric", palette::fabric, 0.95);
    const int plastic_front = glb.add_material("plastic_front", palette::plastic_front, 0.4);
    const int plastic_back = glb.add_material("plastic_back", palette::plastic_back, 0.4);
    if (!mesh.triangles.empty()) {
        const Relief sheet{.positions = result.shape,
                           .normals = vertex_normals(mesh.triangles, result.shape),
                           .layout = mesh.vertices,
                           .triangles = mesh.triangles};
        glb.add_mesh("fabric", sheet, fabric);
        glb.add_mesh("plastic_front",
                     raise(mesh, result.shape, front,
                           {.side = Side::front, .rounding = rounding(front), .segments = 2}),
                     plastic_front);
        glb.add_mesh(
            "plastic_back",
            raise(mesh, result.shape, back, {.side = Side::back, .rounding = rounding(back), .segments = 2}),
            plastic_back);
    }
    return glb.file(result_title(result));
}

}  // namespace ruche
