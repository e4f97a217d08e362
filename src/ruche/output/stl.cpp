#include <Eigen/Geometry>
#include <cstdint>

#include "ruche/output/exporters.hpp"
#include "ruche/output/little_endian.hpp"

namespace ruche {

std::string to_stl(const ExportSurface& surface) {
    std::string out = "Ruche, binary STL, mm";
    out.resize(80, ' ');
    append_bytes(out, static_cast<std::uint32_t>(surface.triangles.size()));
    for (const Triangle& t : surface.triangles) {
        const Vec3& origin = surface.positions[t[0]];
        const Vec3 normal = (surface.positions[t[1]] - origin).cross(surface.positions[t[2]] - origin);
        const Vec3 unit = normal.normalized();
        for (int i = 0; i < 3; ++i) append_bytes(out, static_cast<float>(unit[i]));
        for (const int v : t)
            for (int i = 0; i < 3; ++i) append_bytes(out, static_cast<float>(surface.positions[v][i]));
        append_bytes(out, std::uint16_t{0});
    }
    return out;
}

}  // namespace ruche
