#include "ruche/output/curvature.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "ruche/core/parallel.hpp"

namespace ruche {
namespace {

using Vec5 = Eigen::Matrix<double, 5, 1>;
using Mat5 = Eigen::Matrix<double, 5, 5>;

constexpr std::size_t fit_points = 8;  // five coefficients, and some to spare
constexpr int most_rings = 5;

/// Vertices that share an edge with each vertex, in one array.
struct Neighbours {
    std::vector<int> begin;
    std::vector<int> list;
};

Neighbours find_neighbours(const std::vector<Triangle>& triangles, std::size_t vertex_count) {
    std::vector<int> count(vertex_count + 1, 0);
    for (const Triangle& t : triangles)
        for (const int v : t) count[v + 1] += 2;
    for (std::size_t v = 0; v < vertex_count; ++v) count[v + 1] += count[v];
    std::vector<int> place(count.begin(), count.end() - 1);
    std::vector<int> all(count.back());
    for (const Triangle& t : triangles)
        for (int i = 0; i < 3; ++i) {
            all[place[t[i]]++] = t[(i + 1) % 3];
            all[place[t[i]]++] = t[(i + 2) % 3];
        }
    Neighbours result;
    result.begin.reserve(vertex_count + 1);
    result.begin.push_back(0);
    result.list.reserve(all.size() / 2);
    for (std::size_t v = 0; v < vertex_count; ++v) {
        std::sort(all.begin() + count[v], all.begin() + count[v + 1]);
        for (int i = count[v]; i < count[v + 1]; ++i)
            if (i == count[v] || all[i] != all[i - 1]) result.list.push_back(all[i]);
        result.begin.push_back(static_cast<int>(result.list.size()));
    }
    return result;
}

/// The vertex itself and its rings; at least two rings, more while there are too few points for a fit.
void collect_rings(const Neighbours& neighbours, int vertex, std::vector<int>& ring) {
    ring.assign(1, vertex);
    std::size_t begin = 0;
    for (int k = 0; k < most_rings; ++k) {
        const std::size_t end = ring.size();
        if (begin == end || (k >= 2 && end > fit_points)) return;
        for (std::size_t i = begin; i < end; ++i) {
            const int v = ring[i];
            for (int j = neighbours.begin[v]; j < neighbours.begin[v + 1]; ++j)
                if (std::find(ring.begin(), ring.end(), neighbours.list[j]) == ring.end())
                    ring.push_back(neighbours.list[j]);
        }
        begin = end;
    }
}

/// Solution of a symmetric positive semi-definite system; the one of least norm where it is singular (all
/// points on a line or a conic).
Vec5 solve_least_norm(const Mat5& matrix, const Vec5& right) {
    const Eigen::LDLT<Mat5> factor(matrix);
    const Vec5 pivots = factor.vectorD();
    if (pivots.minCoeff() > 1e-9 * pivots.maxCoeff()) return factor.solve(right);
    const Eigen::SelfAdjointEigenSolver<Mat5> eigen(matrix);
    const double smallest = 1e-9 * eigen.eigenvalues().maxCoeff();
    Vec5 result = Vec5::Zero();
    for (int i = 0; i < 5; ++i) {
        if (eigen.eigenvalues()[i] <= smallest) continue;
        const Vec5 axis = eigen.eigenvectors().col(i);
        result += axis * (axis.dot(right) / eigen.eigenvalues()[i]);
    }
    return result;
}

/// Principal curvatures of the graph z = d u + e v + (a u^2 + 2 b u v + c v^2)/2 at the origin.
VertexCurvature graph_curvature(const Vec5& q) {
    const double d = q[0], e = q[1];
    const double area2 = 1.0 + d * d + e * e;
    const double slope = std::sqrt(area2);
    const double gauss = (q[2] * q[4] - q[3] * q[3]) / (area2 * area2);
    const double mean =
        -((1.0 + d * d) * q[4] - 2.0 * d * e * q[3] + (1.0 + e * e) * q[2]) / (2.0 * area2 * slope);
    const double spread = std::sqrt(std::max(0.0, mean * mean - gauss));
    return {mean + spread, mean - spread};
}

VertexCurvature fit(const std::vector<Vec3>& positions, const Vec3& normal, const std::vector<int>& ring) {
    const Vec3& origin = positions[ring[0]];
    double size = 0.0;
    for (std::size_t i = 1; i < ring.size(); ++i) size += (positions[ring[i]] - origin).norm();
    size /= static_cast<double>(std::max<std::size_t>(1, ring.size() - 1));
    if (!(size > 0.0) || !std::isfinite(size) || normal.squaredNorm() < 0.5) return {};
    const Vec3 u_axis = normal.unitOrthogonal();
    const Vec3 v_axis = normal.cross(u_axis);
    Mat5 matrix = Mat5::Zero();
    Vec5 right = Vec5::Zero();
    for (std::size_t i = 1; i < ring.size(); ++i) {
        const Vec3 r = (positions[ring[i]] - origin) / size;
        const double u = u_axis.dot(r), v = v_axis.dot(r);
        const double weight = 1.0 / (r.squaredNorm() + 0.1);
        const Vec5 row = (Vec5() << u, v, 0.5 * u * u, u * v, 0.5 * v * v).finished();
        matrix += (weight * row) * row.transpose();
        right += (weight * normal.dot(r)) * row;
    }
    VertexCurvature result = graph_curvature(solve_least_norm(matrix, right));
    result.max /= size;
    result.min /= size;
    return std::isfinite(result.max) && std::isfinite(result.min) ? result : VertexCurvature{};
}

}  // namespace

std::vector<Vec3> vertex_normals(const std::vector<Triangle>& triangles, const std::vector<Vec3>& positions) {
    std::vector<Vec3> normals(positions.size(), Vec3::Zero());
    for (const Triangle& t : triangles) {
        const Vec3 normal = (positions[t[1]] - positions[t[0]]).cross(positions[t[2]] - positions[t[0]]);
        const double length = normal.norm();
        if (!(length > 0.0) || !std::isfinite(length)) continue;
        for (int i = 0; i < 3; ++i) {
            const Vec3 a = positions[t[(i + 1) % 3]] - positions[t[i]];
            const Vec3 b = positions[t[(i + 2) % 3]] - positions[t[i]];
            normals[t[i]] += normal * (std::atan2(length, a.dot(b)) / length);
        }
    }
    for (Vec3& n : normals) {
        const double length = n.norm();
        if (length > 0.0) n /= length;
    }
    return normals;
}

std::vector<VertexCurvature> vertex_curvatures(const std::vector<Triangle>& triangles,
                                               const std::vector<Vec3>& positions,
                                               const std::vector<Vec3>& normals) {
    const Neighbours neighbours = find_neighbours(triangles, positions.size());
    std::vector<VertexCurvature> result(positions.size());
    constexpr std::size_t block = 2048;
    parallel_for((positions.size() + block - 1) / block, [&](std::size_t b) {
        std::vector<int> ring;
        for (std::size_t v = b * block; v < std::min(positions.size(), (b + 1) * block); ++v) {
            collect_rings(neighbours, static_cast<int>(v), ring);
            result[v] = fit(positions, normals[v], ring);
        }
    });
    return result;
}

}  // namespace ruche
