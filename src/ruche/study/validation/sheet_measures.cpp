#include "ruche/study/validation/sheet_measures.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <optional>
#include <set>

#include "ruche/geometry/circle_fit.hpp"
#include "ruche/geometry/layout_frame.hpp"
#include "ruche/geometry/strain_measures.hpp"
#include "ruche/meshing/point_locator.hpp"

namespace ruche {
namespace {

using Edges32 = Eigen::Matrix<double, 3, 2>;

/// dx/dX of a triangle.
Edges32 deformation(const TriangleMesh& mesh, std::span<const Vec3> shape, int t) {
    const auto& [a, b, c] = mesh.triangles[static_cast<std::size_t>(t)];
    Mat2 printed;
    printed << mesh.vertices[b] - mesh.vertices[a], mesh.vertices[c] - mesh.vertices[a];
    Edges32 released;
    released << shape[b] - shape[a], shape[c] - shape[a];
    return released * printed.inverse();
}

double angle_at(const Vec3& corner, const Vec3& a, const Vec3& b) {
    return std::atan2((a - corner).cross(b - corner).norm(), (a - corner).dot(b - corner));
}

double released_area(const Triangle& t, std::span<const Vec3> shape) {
    return 0.5 * (shape[t[1]] - shape[t[0]]).cross(shape[t[2]] - shape[t[0]]).norm();
}

constexpr double nothing_there = std::numeric_limits<double>::quiet_NaN();

/// Around a strip's centre line, in the layout.
Eigen::AlignedBox2d strip_box(const PrintMesh& layout, const MeshedStrip& strip) {
    Eigen::AlignedBox2d box;
    for (const auto& line : strip.centreline) {
        for (const MeshPoint& point : line) {
            const Triangle& t = layout.mesh.triangles[static_cast<std::size_t>(point.triangle)];
            Vec2 p = Vec2::Zero();
            for (int i = 0; i < 3; ++i) p += point.weights[i] * layout.mesh.vertices[t[i]];
            box.extend(p);
        }
    }
    return box;
}

/// Around all that is printed.
Eigen::AlignedBox2d print_box(const PrintMesh& layout) {
    Eigen::AlignedBox2d box;
    for (int t = 0; t < layout.mesh.triangle_count(); ++t)
        if (!layout.print[static_cast<std::size_t>(t)].bare())
            for (const int v : layout.mesh.triangles[static_cast<std::size_t>(t)])
                box.extend(layout.mesh.vertices[static_cast<std::size_t>(v)]);
    return box;
}

Eigen::AlignedBox2d middle_of(const Eigen::AlignedBox2d& box, double share) {
    // A sheet of one row is as flat as its strips: a hair of room.
    const Vec2 half = 0.5 * share * box.sizes() + Vec2::Constant(1e-6);
    return {box.center() - half, box.center() + half};
}

Vec3 released_point(const PrintMesh& layout, std::span<const Vec3> shape, const MeshPoint& at) {
    Vec3 sum = Vec3::Zero();
    for (int i = 0; i < 3; ++i)
        sum += at.weights[i] * shape[layout.mesh.triangles[static_cast<std::size_t>(at.triangle)][i]];
    return sum;
}

}  // namespace

double transverse_stretch(const PrintMesh& layout, std::span<const Vec3> shape, const LayoutRing& ring) {
    double sum = 0.0;
    double area = 0.0;
    for (int t = 0; t < layout.mesh.triangle_count(); ++t) {
        const Vec2 centre = layout_centroid(layout.mesh, t);
        if (!ring.holds(centre)) continue;
        const Vec2 out = centre - ring.middle;
        const Vec2 around = Vec2(-out.y(), out.x()).normalized();
        sum += layout_area(layout.mesh, t) * (deformation(layout.mesh, shape, t) * around).norm();
        area += layout_area(layout.mesh, t);
    }
    return area > 0.0 ? sum / area : nothing_there;
}

IntegratedCurvature integrated_curvature(const PrintMesh& layout, std::span<const Vec3> shape,
                                         const LayoutRing& ring) {
    const TriangleMesh& mesh = layout.mesh;
    std::vector<double> defect(mesh.vertices.size(), 2.0 * M_PI);
    double area = 0.0;
    for (int t = 0; t < mesh.triangle_count(); ++t) {
        const Triangle& corners = mesh.triangles[static_cast<std::size_t>(t)];
        if (ring.holds(layout_centroid(mesh, t))) area += released_area(corners, shape);
        for (int i = 0; i < 3; ++i)
            defect[corners[i]] -=
                angle_at(shape[corners[i]], shape[corners[(i + 1) % 3]], shape[corners[(i + 2) % 3]]);
    }
    double bend = 0.0;
    for (const Edge& edge : find_edges(mesh).edges) {
        if (edge.on_boundary()) {
            for (const int v : edge.vertex) defect[v] = 0.0;
            continue;
        }
        const auto [a, b] = edge.vertex;
        if (!ring.holds(0.5 * (mesh.vertices[a] + mesh.vertices[b]))) continue;
        const Vec3& left = shape[mesh.triangles[edge.triangle[0]][edge.local[0]]];
        const Vec3& right = shape[mesh.triangles[edge.triangle[1]][edge.local[1]]];
        const double angle = dihedral_angle(dihedral_frame(shape[a], shape[b], left),
                                            dihedral_frame(shape[b], shape[a], right));
        // The dihedral angle is positive where neighbours rise towards the front, curvature where they sink.
        bend -= 0.5 * (shape[b] - shape[a]).norm() * angle;
    }
    double gauss = 0.0;
    for (std::size_t v = 0; v < defect.size(); ++v)
        if (ring.holds(mesh.vertices[v])) gauss += defect[v];
    if (!(area > 0.0)) return {nothing_there, nothing_there};
    return {gauss / area, bend / area};
}

VertexCurvature fitted_curvature(const PrintMesh& layout, std::span<const Vec3> shape,
                                 const LayoutRing& ring) {
    const std::vector<Vec3> positions(shape.begin(), shape.end());
    const std::vector<VertexCurvature> at_vertices =
        vertex_curvatures(layout.mesh.triangles, positions, vertex_normals(layout.mesh.triangles, positions));
    double area = 0.0;
    VertexCurvature sum;
    for (int t = 0; t < layout.mesh.triangle_count(); ++t) {
        const double share = layout_area(layout.mesh, t) / 3.0;
        for (const int v : layout.mesh.triangles[static_cast<std::size_t>(t)]) {
            if (!ring.holds(layout.mesh.vertices[v])) continue;
            area += share;
            sum.max += share * at_vertices[v].max;
            sum.min += share * at_vertices[v].min;
        }
    }
    if (!(area > 0.0)) return {nothing_there, nothing_there};
    return {sum.max / area, sum.min / area};
}

Vec3 position_of(const PrintMesh& layout, std::span<const Vec3> shape, const Vec2& point) {
    constexpr double rounding = 1e-6;  // mm: a point of the outline may lie a hair outside
    const std::optional<MeshPoint> at = PointLocator(layout.mesh).find(point, rounding);
    return at ? released_point(layout, shape, *at) : Vec3::Constant(nothing_there);
}

HelixFit strip_helix(const PrintMesh& layout, std::span<const Vec3> shape, int strip) {
    const auto& lines = layout.strips[static_cast<std::size_t>(strip)].centreline;
    if (lines.empty()) return {};
    std::vector<Vec3> points;
    points.reserve(lines.front().size());
    for (const MeshPoint& at : lines.front()) points.push_back(released_point(layout, shape, at));
    return fit_helix(points);
}

double silhouette_curvature(const PrintMesh& layout, std::span<const Vec3> shape, double share,
                            const Vec2& along) {
    const Eigen::AlignedBox2d inside = middle_of(print_box(layout), share);
    Vec3 sight = Vec3::Zero();
    std::set<int> printed;
    for (int t = 0; t < layout.mesh.triangle_count(); ++t) {
        if (share < 1.0 && !inside.contains(layout_centroid(layout.mesh, t))) continue;
        sight += layout_area(layout.mesh, t) * (deformation(layout.mesh, shape, t) * along);
        if (layout.print[static_cast<std::size_t>(t)].bare()) continue;
        printed.insert(layout.mesh.triangles[static_cast<std::size_t>(t)].begin(),
                       layout.mesh.triangles[static_cast<std::size_t>(t)].end());
    }
    if (!(sight.norm() > 0.0)) return nothing_there;
    sight.normalize();
    std::vector<Vec3> seen;
    seen.reserve(printed.size());
    for (const int v : printed) seen.emplace_back(shape[v] - sight.dot(shape[v]) * sight);
    const CircleFit circle = fit_circle(seen);
    return circle.valid ? circle.curvature : nothing_there;
}

std::vector<int> chosen_strips(const PrintMesh& layout, const std::string& begin, double share) {
    std::vector<Eigen::AlignedBox2d> boxes;
    Eigen::AlignedBox2d all;
    for (const MeshedStrip& strip : layout.strips) {
        boxes.push_back(strip_box(layout, strip));
        all.extend(boxes.back());
    }
    const Eigen::AlignedBox2d inside = middle_of(all, share);
    std::vector<int> chosen;
    for (std::size_t s = 0; s < boxes.size(); ++s)
        if (layout.strips[s].id.starts_with(begin) && !boxes[s].isEmpty() && inside.contains(boxes[s]))
            chosen.push_back(static_cast<int>(s));
    return chosen;
}

PrintMesh with_middles(PrintMesh layout, double share) {
    for (MeshedStrip& strip : layout.strips) {
        for (std::vector<MeshPoint>& line : strip.centreline) {
            // Points are evenly spaced.
            const auto cut = std::lround(0.5 * (1.0 - share) * static_cast<double>(line.size() - 1));
            line.assign(line.begin() + cut, line.end() - cut);
        }
    }
    return layout;
}

}  // namespace ruche
