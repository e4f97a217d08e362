#include "ruche/statics/transfer.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "ruche/core/parallel.hpp"
#include "ruche/meshing/point_locator.hpp"

namespace ruche {
namespace {

constexpr double open_enough = 0.85;  // of the length of fabric at rest

using Gradient = Eigen::Matrix<double, 3, 2>;  // of positions over the layout

/// F = R [U; 0]: a rotation of space and a symmetric stretch of the layout's plane.
struct Polar {
    Mat3 rotation;
    Mat2 stretch;
};

Gradient edges(const TriangleMesh& layout, const Eigen::VectorXd& x, int t) {
    const Triangle& v = layout.triangles[t];
    const auto at = [&](int corner) { return x.segment<3>(3 * static_cast<Eigen::Index>(v[corner])); };
    Gradient d;
    d << at(1) - at(0), at(2) - at(0);
    return d;
}

Mat2 layout_edges(const TriangleMesh& layout, int t) {
    const Triangle& v = layout.triangles[t];
    Mat2 e;
    e << layout.vertices[v[1]] - layout.vertices[v[0]], layout.vertices[v[2]] - layout.vertices[v[0]];
    return e;
}

Polar polar_decomposition(const Gradient& f) {
    const Eigen::SelfAdjointEigenSolver<Mat2> eigen(f.transpose() * f);
    const Vec2 stretches = eigen.eigenvalues().cwiseMax(1e-12).cwiseSqrt();
    const Mat2& axes = eigen.eigenvectors();
    Polar polar;
    polar.stretch = axes * stretches.asDiagonal() * axes.transpose();
    polar.rotation.leftCols<2>() = f * (axes * stretches.cwiseInverse().asDiagonal() * axes.transpose());
    polar.rotation.col(2) = polar.rotation.col(0).cross(polar.rotation.col(1));
    return polar;
}

/// The stretch with no principal value below `shortest`.
Mat2 opened(const Mat2& stretch, double shortest) {
    const Eigen::SelfAdjointEigenSolver<Mat2> eigen(stretch);
    return eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(shortest).asDiagonal() *
           eigen.eigenvectors().transpose();
}

/// The rotation nearest to a matrix (least squares), a mean of rotations when the matrix is their sum.
Mat3 nearest_rotation(const Mat3& m) {
    // Newton's iteration for the polar factor (Higham 1986); rotations that are summed are nearly the same.
    Mat3 q = m / std::cbrt(m.determinant());
    for (int step = 0; step < 8; ++step) {
        const Mat3 next = 0.5 * (q + q.inverse().transpose());
        const double change = (next - q).squaredNorm();
        q = next;
        if (change < 1e-16) return q;
    }
    const Eigen::JacobiSVD<Mat3> svd(m, Eigen::ComputeFullU | Eigen::ComputeFullV);
    const double sign = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0 ? -1.0 : 1.0;
    return svd.matrixU() * Vec3(1.0, 1.0, sign).asDiagonal() * svd.matrixV().transpose();
}

/// Where points of a layout lie on the old mesh.
class Source {
  public:
    explicit Source(const LayoutShape& shape) : shape_(shape), locator_(shape.layout) {
        Vec2 low = shape.layout.vertices.front();
        Vec2 high = low;
        for (const Vec2& p : shape.layout.vertices) {
            low = low.cwiseMin(p);
            high = high.cwiseMax(p);
        }
        everywhere_ = 2.0 * (high - low).norm();
    }

    /// On a triangle that is bare or printed as wanted, when there is one within a few elements.
    MeshPoint find(const Vec2& p, bool bare) const {
        const auto same = [&](int t) { return shape_.print.empty() || shape_.print[t].bare() == bare; };
        if (const auto near = locator_.find(p, nearby_, same)) return *near;
        for (double reach = nearby_; reach < everywhere_; reach *= 4.0) {
            if (const auto any = locator_.find(p, reach)) return *any;
        }
        return {.triangle = 0, .weights = {1.0, 0.0, 0.0}};
    }

  private:
    static constexpr double nearby_ = 2.0;  // mm
    const LayoutShape& shape_;
    PointLocator locator_;
    double everywhere_ = 0.0;
};

}  // namespace

Eigen::VectorXd transfer(const LayoutShape& from, const Model& to, Retraction& retraction) {
    const TriangleMesh& old = from.layout;
    // Means over the triangles around each vertex: constants per triangle would leave jumps at the old edges,
    // which crush small elements. Stretches of plastic and of fabric are means of their own.
    std::vector<Mat3> sums(old.vertices.size(), Mat3::Zero());
    std::array<std::vector<Mat2>, 2> stretches;
    std::array<std::vector<double>, 2> areas;
    for (const int kind : {0, 1}) {
        stretches[kind].assign(old.vertices.size(), Mat2::Zero());
        areas[kind].assign(old.vertices.size(), 0.0);
    }
    const auto is_plastic = [&](int t) { return !from.print.empty() && !from.print[t].bare(); };
    for (int t = 0; t < old.triangle_count(); ++t) {
        const Polar polar = polar_decomposition(edges(old, from.x, t) * layout_edges(old, t).inverse());
        const bool plastic = is_plastic(t);
        const double area = layout_area(old, t);
        for (const int v : old.triangles[t]) {
            sums[v] += (plastic ? 100.0 : 1.0) * area * polar.rotation;
            stretches[plastic][v] += area * polar.stretch;
            areas[plastic][v] += area;
        }
    }
    const auto mean_stretch = [&](const MeshPoint& point) {
        const bool plastic = is_plastic(point.triangle);
        Mat2 mean = Mat2::Zero();
        for (int i = 0; i < 3; ++i) {
            const int v = old.triangles[point.triangle][i];
            mean += point.weights[i] / areas[plastic][v] * stretches[plastic][v];
        }
        return mean;
    };
    std::vector<Mat3> rotations(sums.size());
    for (std::size_t v = 0; v < sums.size(); ++v) rotations[v] = nearest_rotation(sums[v]);

    const Source source(from);
    const TriangleMesh& mesh = to.input().mesh;
    const std::array<double, 2>& prestretch = to.input().prestretch;
    const double shortest = open_enough / std::max(prestretch[0], prestretch[1]);
    std::vector<Gradient> wanted(mesh.triangles.size());
    std::vector<Vec3> place(mesh.triangles.size(), Vec3::Zero());
    constexpr int chunk = 256;
    parallel_for((mesh.triangles.size() + chunk - 1) / chunk, [&](std::size_t block) {
        const int end = std::min(mesh.triangle_count(), static_cast<int>(block + 1) * chunk);
        for (int t = static_cast<int>(block) * chunk; t < end; ++t) {
            const Triangle& v = mesh.triangles[t];
            const Vec2 centre = (mesh.vertices[v[0]] + mesh.vertices[v[1]] + mesh.vertices[v[2]]) / 3.0;
            const MeshPoint point = source.find(centre, to.input().print[t].bare());
            Mat3 blend = Mat3::Zero();
            for (int i = 0; i < 3; ++i) {
                const int corner = old.triangles[point.triangle][i];
                blend += point.weights[i] * rotations[corner];
                place[t] += point.weights[i] * from.x.segment<3>(3 * static_cast<Eigen::Index>(corner));
            }
            const Mat3 rotation = nearest_rotation(blend);
            Mat2 stretch = mean_stretch(point);
            if (to.input().print[t].bare()) stretch = opened(stretch, shortest);
            wanted[t] = rotation.leftCols<2>() * stretch * layout_edges(mesh, t);
        }
    });
    // A first guess in the right place; its own edges do not matter.
    Eigen::VectorXd x = to.initial();
    for (int t = 0; t < mesh.triangle_count(); ++t) {
        for (const int v : mesh.triangles[t]) x.segment<3>(3 * static_cast<Eigen::Index>(v)) = place[t];
    }
    return retraction.with_edges(x, wanted);
}

}  // namespace ruche
