#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "ruche/output/exporters.hpp"
#include "ruche/output/palette.hpp"
#include "ruche/output/text_rows.hpp"

namespace ruche {
namespace {

struct NamedColour {
    const char* name;
    Colour colour;
};

/// In the order of PrintedSide.
constexpr NamedColour materials[] = {{"fabric", palette::fabric},
                                     {"plastic_front", palette::plastic_front},
                                     {"plastic_back", palette::plastic_back},
                                     {"plastic_both", palette::plastic_front}};

/// A name without what OBJ readers take for a separator.
std::string one_word(std::string name) {
    for (char& c : name)
        if (static_cast<unsigned char>(c) <= ' ' || c == '#' || c == '\\') c = '_';
    return name.empty() ? "_" : name;
}

std::vector<int> sorted_by_strip(const ExportSurface& surface) {
    std::vector<int> order(surface.triangles.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
        return std::pair(surface.strip[a], surface.side[a]) < std::pair(surface.strip[b], surface.side[b]);
    });
    return order;
}

}  // namespace

std::string to_obj(const ExportSurface& surface, const std::string& material_file) {
    std::string text =
        fmt::format("# {} (mm; vt: the flat layout)\nmtllib {}\n", one_word(surface.title), material_file);
    append_rows(text, surface.positions.size(), [&](auto out, std::size_t v) {
        const Vec3& p = surface.positions[v];
        fmt::format_to(out, "v {} {} {}\n", p.x(), p.y(), p.z());
    });
    append_rows(text, surface.layout.size(), [&](auto out, std::size_t v) {
        fmt::format_to(out, "vt {} {}\n", surface.layout[v].x(), surface.layout[v].y());
    });
    append_rows(text, surface.normals.size(), [&](auto out, std::size_t v) {
        const Eigen::Vector3f n = surface.normals[v].cast<float>();
        fmt::format_to(out, "vn {} {} {}\n", n.x(), n.y(), n.z());
    });
    const std::vector<int> order = sorted_by_strip(surface);
    append_rows(text, order.size(), [&](auto out, std::size_t i) {
        const int t = order[i];
        const int strip = surface.strip[t];
        const PrintedSide side = surface.side[t];
        const bool new_group = i == 0 || strip != surface.strip[order[i - 1]];
        if (new_group)
            out = fmt::format_to(out, "g {}\n", strip < 0 ? "fabric" : one_word(surface.strip_ids[strip]));
        if (new_group || side != surface.side[order[i - 1]])
            out = fmt::format_to(out, "usemtl {}\n", materials[static_cast<int>(side)].name);
        const auto [a, b, c] = surface.triangles[t];
        fmt::format_to(out, "f {0}/{0}/{0} {1}/{1}/{1} {2}/{2}/{2}\n", a + 1, b + 1, c + 1);
    });
    return text;
}

std::string obj_materials() {
    std::string text;
    for (const NamedColour& material : materials) {
        const auto& c = material.colour.srgb;
        text += fmt::format("newmtl {}\nKd {:.4f} {:.4f} {:.4f}\nKs 0.04 0.04 0.04\nNs 20\nd 1\nillum 2\n\n",
                            material.name, c[0] / 255.0, c[1] / 255.0, c[2] / 255.0);
    }
    return text;
}

}  // namespace ruche
