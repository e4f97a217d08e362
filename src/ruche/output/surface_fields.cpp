#include "ruche/output/surface_fields.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace ruche {
namespace {

struct Stretches {
    double max = 0.0;
    double min = 0.0;
};

/// Singular values of the linear map that takes a triangle of the layout to the shape.
Stretches principal_stretches(const TriangleMesh& mesh, const std::vector<Vec3>& shape, int triangle) {
    const Triangle& t = mesh.triangles[triangle];
    Mat2 printed;
    printed << mesh.vertices[t[1]] - mesh.vertices[t[0]], mesh.vertices[t[2]] - mesh.vertices[t[0]];
    if (!(std::abs(printed.determinant()) > 0.0)) return {};
    Eigen::Matrix<double, 3, 2> released;
    released << shape[t[1]] - shape[t[0]], shape[t[2]] - shape[t[0]];
    const Eigen::Matrix<double, 3, 2> map = released * printed.inverse();
    const double xx = map.col(0).squaredNorm(), yy = map.col(1).squaredNorm(),
                 xy = map.col(0).dot(map.col(1));
    const double mean = 0.5 * (xx + yy);
    const double spread = std::hypot(0.5 * (xx - yy), xy);
    if (!std::isfinite(mean)) return {};
    const double max = std::sqrt(mean + spread);
    // The smaller one by way of the area: mean - spread would lose digits in a very stretched triangle.
    const double area = map.col(0).cross(map.col(1)).norm();
    return {max, max > 0.0 ? area / max : 0.0};
}

Vec3 unit_normal(const Triangle& t, const std::vector<Vec3>& shape) {
    const Vec3 normal = (shape[t[1]] - shape[t[0]]).cross(shape[t[2]] - shape[t[0]]);
    const double length = normal.norm();
    if (!(length > 0.0) || !std::isfinite(length)) return Vec3::Zero();
    return normal / length;
}

}  // namespace

PrintedSide printed_side(const Print& print) {
    return static_cast<PrintedSide>((print.front > 0.0 ? 1 : 0) + (print.back > 0.0 ? 2 : 0));
}

SurfaceFields surface_fields(const Result& result, std::span<const double> energy_density) {
    const TriangleMesh& mesh = result.layout.mesh;
    SurfaceFields fields;
    fields.vertex_normal = vertex_normals(mesh.triangles, result.shape);
    fields.vertex_curvature = vertex_curvatures(mesh.triangles, result.shape, fields.vertex_normal);
    fields.energy_density.assign(energy_density.begin(), energy_density.end());
    const bool own_moduli = std::ranges::any_of(result.layout.print, [](const Print& print) {
        return print.front_modulus != 0.0 || print.back_modulus != 0.0;
    });
    fields.passes_through = passes_through_itself(result);
    for (int t = 0; t < mesh.triangle_count(); ++t) {
        const Print print = result.layout.print.empty() ? Print{} : result.layout.print[t];
        fields.front_mm.push_back(print.front);
        fields.back_mm.push_back(print.back);
        if (own_moduli) {
            fields.front_modulus_mpa.push_back(print.front_modulus);
            fields.back_modulus_mpa.push_back(print.back_modulus);
        }
        fields.side.push_back(printed_side(print));
        const bool numbered = !result.layout.strip.empty();
        fields.strip.push_back(numbered ? main_strip(result.layout, t) : -1);
        fields.strips.push_back(numbered ? result.layout.strip[t] : StripPair{});
        fields.face_normal.push_back(unit_normal(mesh.triangles[t], result.shape));
        VertexCurvature curvature;
        for (const int v : mesh.triangles[t]) {
            curvature.max += fields.vertex_curvature[v].max / 3.0;
            curvature.min += fields.vertex_curvature[v].min / 3.0;
        }
        fields.face_curvature.push_back(curvature);
        const Stretches stretches = principal_stretches(mesh, result.shape, t);
        fields.stretch_max.push_back(stretches.max);
        fields.stretch_min.push_back(stretches.min);
    }
    return fields;
}

}  // namespace ruche
