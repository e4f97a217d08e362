#include "ruche/geometry/layout_frame.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <numbers>

namespace ruche {

Vec2 layout_centroid(const TriangleMesh& mesh, int triangle) {
    const Triangle& v = mesh.triangles[triangle];
    return (mesh.vertices[v[0]] + mesh.vertices[v[1]] + mesh.vertices[v[2]]) / 3.0;
}

LayoutFrame layout_frame(const TriangleMesh& mesh) {
    LayoutFrame frame;
    double area = 0.0;
    for (int t = 0; t < mesh.triangle_count(); ++t) {
        frame.centre += layout_area(mesh, t) * layout_centroid(mesh, t);
        area += layout_area(mesh, t);
    }
    frame.centre /= area;
    // Exact for the polygon, so that the frame does not depend on how it is meshed: the second moments of a
    // triangle are those of its three edge midpoints with a third of its area each.
    Mat2 moments = Mat2::Zero();
    for (int t = 0; t < mesh.triangle_count(); ++t) {
        const Triangle& v = mesh.triangles[t];
        for (int i = 0; i < 3; ++i) {
            const Vec2 p = 0.5 * (mesh.vertices[v[i]] + mesh.vertices[v[(i + 1) % 3]]) - frame.centre;
            moments += layout_area(mesh, t) / 3.0 * p * p.transpose();
        }
    }
    const Vec2 direction = Eigen::SelfAdjointEigenSolver<Mat2>(moments).eigenvectors().col(1);
    frame.longest = std::atan2(direction.y(), direction.x());
    if (frame.longest > 0.5 * std::numbers::pi) frame.longest -= std::numbers::pi;
    if (frame.longest <= -0.5 * std::numbers::pi) frame.longest += std::numbers::pi;
    return frame;
}

}  // namespace ruche
