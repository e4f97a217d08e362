#include "ruche/output/metrics.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "ruche/geometry/circle_fit.hpp"

namespace ruche {
namespace {

constexpr double flat_below = 1e-6;                // 1/mm: a radius of a kilometre
constexpr double most_turn = 30.0 * M_PI / 180.0;  // of a piece in the layout
constexpr std::size_t fewest_points = 5;           // of a piece that is cut off for its turn

/// One point of a centre line, printed and released.
struct Sample {
    Vec2 layout;
    Vec3 point;                  ///< on the flat triangle
    std::array<Vec3, 3> spokes;  ///< from the point to the triangle's vertices, released
    std::array<double, 3> weights;
    Vec3 normal;                              ///< of the released triangle, towards the front
    Eigen::Matrix<double, 3, 2> deformation;  ///< layout direction -> released direction
};

Sample sample_at(const PrintMesh& layout, std::span<const Vec3> shape, const MeshPoint& at) {
    const Triangle& tri = layout.mesh.triangles[at.triangle];
    const auto& flat = layout.mesh.vertices;
    Sample s;
    s.weights = {at.weights[0], at.weights[1], at.weights[2]};
    s.layout = at.weights[0] * flat[tri[0]] + at.weights[1] * flat[tri[1]] + at.weights[2] * flat[tri[2]];
    s.point = at.weights[0] * shape[tri[0]] + at.weights[1] * shape[tri[1]] + at.weights[2] * shape[tri[2]];
    for (int i = 0; i < 3; ++i) s.spokes[i] = shape[tri[i]] - s.point;
    Eigen::Matrix<double, 3, 2> released;
    released << shape[tri[1]] - shape[tri[0]], shape[tri[2]] - shape[tri[0]];
    Mat2 printed;
    printed << flat[tri[1]] - flat[tri[0]], flat[tri[2]] - flat[tri[0]];
    s.deformation = released * printed.inverse();
    s.normal = released.col(0).cross(released.col(1)).normalized();
    return s;
}

using Samples = std::span<const Sample>;

double printed_length(Samples line) {
    double length = 0.0;
    for (std::size_t i = 1; i < line.size(); ++i) length += (line[i].layout - line[i - 1].layout).norm();
    return length;
}

/// Direction of the line in the layout at sample i.
Vec2 direction(Samples line, std::size_t i) {
    const std::size_t before = i == 0 ? 0 : i - 1;
    const std::size_t after = std::min(i + 1, line.size() - 1);
    return (line[after].layout - line[before].layout).normalized();
}

/// Turning of the layout's line at each sample, radians; 0 at both ends.
std::vector<double> turns_of(Samples line) {
    std::vector<double> turns(line.size(), 0.0);
    for (std::size_t i = 1; i + 1 < line.size(); ++i) {
        const Vec2 in = line[i].layout - line[i - 1].layout;
        const Vec2 out = line[i + 1].layout - line[i].layout;
        turns[i] = std::atan2(in.x() * out.y() - in.y() * out.x(), in.dot(out));
    }
    return turns;
}

/// Cuts a line where its direction in the layout has turned by `most_turn` since the piece began. A step
/// that turns as much by itself cuts a corner of the drawing: it belongs to no piece. Pieces too short to fit
/// a circle to are left out, unless there is nothing else.
std::vector<Samples> nearly_straight_pieces(Samples line) {
    const std::vector<double> turns = turns_of(line);
    std::vector<Samples> pieces;
    std::size_t begin = 0;
    double turned = 0.0;
    const auto end_piece = [&](std::size_t last, std::size_t next) {
        if (last + 1 >= begin + fewest_points) pieces.push_back(line.subspan(begin, last + 1 - begin));
        begin = next;
        turned = 0.0;
    };
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
        if (i > begin) turned += turns[i];
        if (std::abs(turns[i] + turns[i + 1]) > most_turn)
            end_piece(i, i + 1);
        else if (std::abs(turned) > most_turn)
            end_piece(i, i);
    }
    end_piece(line.size() - 1, line.size());
    if (pieces.empty()) pieces.push_back(line);
    return pieces;
}

/// The circle through the smooth line of which `piece` is the polyhedral picture: see the header.
CircleFit fit_smooth(Samples piece) {
    std::vector<Vec3> points(piece.size());
    for (std::size_t i = 0; i < piece.size(); ++i) points[i] = piece[i].point;
    CircleFit fit = fit_circle(points);
    // Each round shrinks the error by sagitta / radius, about 1/500 for elements of 10 degrees.
    for (int round = 0; round < 6 && fit.valid && fit.curvature > flat_below; ++round) {
        const double before = fit.curvature;
        const Vec3 centre = fit.centre();
        for (std::size_t i = 0; i < piece.size(); ++i) {
            double moment = 0.0;
            for (int k = 0; k < 3; ++k) {
                const Vec3& spoke = piece[i].spokes[k];
                const double beside = spoke.dot(fit.normal);
                moment += piece[i].weights[k] * (spoke.squaredNorm() - beside * beside);
            }
            Vec3 outward = piece[i].point - centre;
            outward -= fit.normal * fit.normal.dot(outward);
            const double distance = outward.norm();
            // sqrt(d^2 + m) - d; what is not a small correction is not an arc: leave it.
            const double lift = std::max(0.0, moment) / (std::sqrt(distance * distance + moment) + distance);
            points[i] = piece[i].point + outward * (lift / std::max(distance, 1e-300));
        }
        fit = fit_circle(points);
        if (std::abs(fit.curvature - before) <= 1e-13 * before) break;
    }
    return fit;
}

/// Normal curvature from the curvature of the line by Meusnier's theorem: the part of the direction to the
/// centre that lies along the normal n, the rest lies along the binormal n x t. Dividing by both together
/// takes out the tilt of the triangles along the line; the means with sign take out the tilt across.
double normal_curvature(const CircleFit& fit, Samples piece) {
    const Vec3 centre = fit.centre();
    double along_normal = 0.0;
    double along_binormal = 0.0;
    for (std::size_t i = 0; i < piece.size(); ++i) {
        const Vec3 inward =
            fit.curvature > flat_below ? Vec3((centre - piece[i].point).normalized()) : fit.inward;
        const Vec3 tangent = (piece[i].deformation * direction(piece, i)).normalized();
        along_normal += inward.dot(piece[i].normal);
        along_binormal += inward.dot(piece[i].normal.cross(tangent));
    }
    const double both = std::hypot(along_normal, along_binormal);
    // The centre on the front side (along n) means that the front is concave: negative.
    return both > 0.0 ? -fit.curvature * along_normal / both : 0.0;
}

/// Length-weighted sums over the pieces of a strip.
struct Sums {
    double curvature = 0.0;
    double square_distance = 0.0;
    double fitted_length = 0.0;
    double released = 0.0;
    double printed = 0.0;
};

void add_line(Samples line, Sums& sums) {
    for (std::size_t i = 1; i < line.size(); ++i) {
        const Vec2 step = line[i].layout - line[i - 1].layout;
        sums.printed += step.norm();
        sums.released +=
            0.5 * ((line[i - 1].deformation * step).norm() + (line[i].deformation * step).norm());
    }
    for (const Samples piece : nearly_straight_pieces(line)) {
        const CircleFit fit = fit_smooth(piece);
        const double length = printed_length(piece);
        if (!fit.valid || !(length > 0.0)) continue;
        sums.curvature += length * normal_curvature(fit, piece);
        sums.square_distance += length * fit.rms * fit.rms;
        sums.fitted_length += length;
    }
}

}  // namespace

std::vector<StripMetrics> measure_strips(const PrintMesh& layout, std::span<const Vec3> shape) {
    std::vector<StripMetrics> metrics;
    metrics.reserve(layout.strips.size());
    for (const MeshedStrip& strip : layout.strips) {
        Sums sums;
        for (const std::vector<MeshPoint>& centreline : strip.centreline) {
            std::vector<Sample> line;
            line.reserve(centreline.size());
            for (const MeshPoint& at : centreline) {
                if (at.triangle >= 0) line.push_back(sample_at(layout, shape, at));
            }
            if (line.size() > 1) add_line(line, sums);
        }
        StripMetrics m{.id = strip.id};
        const double curvature = sums.curvature / sums.fitted_length;  // NaN without a fit
        m.curvature = curvature;
        m.radius = std::abs(curvature) < flat_below ? std::numeric_limits<double>::infinity()
                                                    : 1.0 / std::abs(curvature);
        m.fit_rms = std::sqrt(sums.square_distance / sums.fitted_length);
        m.stretch = sums.released / sums.printed;
        m.printed_length = sums.printed;
        metrics.push_back(m);
    }
    return metrics;
}

ShapeMetrics measure_shape(const PrintMesh& layout, std::span<const Vec3> shape) {
    ShapeMetrics m;
    if (shape.empty()) return m;
    m.box_min = m.box_max = shape.front();
    for (const Vec3& x : shape) {
        m.box_min = m.box_min.cwiseMin(x);
        m.box_max = m.box_max.cwiseMax(x);
    }
    for (int t = 0; t < layout.mesh.triangle_count(); ++t) {
        const Triangle& tri = layout.mesh.triangles[t];
        const double flat = layout_area(layout.mesh, t);
        m.layout_area += flat;
        m.area += 0.5 * (shape[tri[1]] - shape[tri[0]]).cross(shape[tri[2]] - shape[tri[0]]).norm();
        if (!layout.print[t].bare()) m.printed_area += flat;
    }
    return m;
}

}  // namespace ruche
