#include "ruche/output/metrics.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <unsupported/Eigen/AutoDiff>

#include "ruche/geometry/circle_fit.hpp"

namespace ruche {
namespace {

constexpr double flat_below = 1e-6;                // 1/mm: a radius of a kilometre
constexpr double most_turn = 30.0 * M_PI / 180.0;  // of a piece in the layout
constexpr int most_rounds = 30;                    // of a fit
constexpr std::size_t fewest_points = 5;           // of a piece that is cut off for its turn

/// A number with its rate of change while the shape moves. What depends on the shape is written once, for
/// numbers with a rate and without.
using MovingNumber = Eigen::AutoDiffScalar<Eigen::Matrix<double, 1, 1>>;
template <class Number>
using SpacePoint = Eigen::Matrix<Number, 3, 1>;

double still_number(double x) { return x; }
double still_number(const MovingNumber& x) { return x.value(); }
Vec3 still_point(const SpacePoint<MovingNumber>& x) { return {x.x().value(), x.y().value(), x.z().value()}; }
Vec3 rates_of(const SpacePoint<MovingNumber>& x) {
    return {x.x().derivatives()[0], x.y().derivatives()[0], x.z().derivatives()[0]};
}
MovingNumber with_rate(double value, double rate) { return {value, Eigen::Matrix<double, 1, 1>(rate)}; }
SpacePoint<MovingNumber> with_rate(const Vec3& value, const Vec3& rate) {
    return {with_rate(value.x(), rate.x()), with_rate(value.y(), rate.y()), with_rate(value.z(), rate.z())};
}

/// The released positions, with or without their velocities.
struct StillPositions {
    std::span<const Vec3> positions;
    Vec3 operator[](int vertex) const { return positions[static_cast<std::size_t>(vertex)]; }
};
struct MovingPositions {
    std::span<const Vec3> positions;
    std::span<const Vec3> velocities;
    SpacePoint<MovingNumber> operator[](int vertex) const {
        return with_rate(positions[static_cast<std::size_t>(vertex)],
                         velocities[static_cast<std::size_t>(vertex)]);
    }
};

/// One point of a centre line, printed and released.
template <class Number>
struct StripSample {
    Vec2 layout;
    SpacePoint<Number> point;                  ///< on the flat triangle
    std::array<SpacePoint<Number>, 3> spokes;  ///< from the point to the triangle's vertices, released
    std::array<double, 3> weights;
    SpacePoint<Number> normal;                ///< of the released triangle, towards the front
    Eigen::Matrix<Number, 3, 2> deformation;  ///< layout direction -> released direction
};

template <class Number, class Positions>
StripSample<Number> sample_at(const PrintMesh& layout, const Positions& shape, const MeshPoint& at) {
    const Triangle& tri = layout.mesh.triangles[at.triangle];
    const auto& flat = layout.mesh.vertices;
    StripSample<Number> s;
    s.weights = {at.weights[0], at.weights[1], at.weights[2]};
    s.layout = at.weights[0] * flat[tri[0]] + at.weights[1] * flat[tri[1]] + at.weights[2] * flat[tri[2]];
    const std::array<SpacePoint<Number>, 3> x = {shape[tri[0]], shape[tri[1]], shape[tri[2]]};
    s.point = Number(at.weights[0]) * x[0] + Number(at.weights[1]) * x[1] + Number(at.weights[2]) * x[2];
    for (int i = 0; i < 3; ++i) s.spokes[i] = x[i] - s.point;
    Eigen::Matrix<Number, 3, 2> released;
    released << x[1] - x[0], x[2] - x[0];
    Mat2 printed;
    printed << flat[tri[1]] - flat[tri[0]], flat[tri[2]] - flat[tri[0]];
    s.deformation = released * Mat2(printed.inverse()).cast<Number>();
    s.normal = released.col(0).cross(released.col(1)).normalized();
    return s;
}

template <class Number>
using StripSamples = std::span<const StripSample<Number>>;

template <class Number>
double printed_length(StripSamples<Number> line) {
    double length = 0.0;
    for (std::size_t i = 1; i < line.size(); ++i) length += (line[i].layout - line[i - 1].layout).norm();
    return length;
}

/// Direction of the line in the layout at sample i.
template <class Number>
Vec2 direction(StripSamples<Number> line, std::size_t i) {
    const std::size_t before = i == 0 ? 0 : i - 1;
    const std::size_t after = std::min(i + 1, line.size() - 1);
    return (line[after].layout - line[before].layout).normalized();
}

/// Turning of the layout's line at each sample, radians; 0 at both ends.
template <class Number>
std::vector<double> turns_of(StripSamples<Number> line) {
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
template <class Number>
std::vector<StripSamples<Number>> nearly_straight_pieces(StripSamples<Number> line) {
    const std::vector<double> turns = turns_of(line);
    std::vector<StripSamples<Number>> pieces;
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

/// What of a fitted circle moves with the shape.
template <class Number>
struct MeasuredCircle {
    Number curvature;
    SpacePoint<Number> centre;
    SpacePoint<Number> normal;
    CircleFit fit;
};

/// The point of the smooth line of which the samples are the polyhedral picture (see the header), if it lies
/// on a circle of this centre and normal.
template <class Number>
SpacePoint<Number> on_smooth_line(const StripSample<Number>& sample, const SpacePoint<Number>& centre,
                                  const SpacePoint<Number>& normal) {
    using std::sqrt;
    Number moment(0.0);
    for (int k = 0; k < 3; ++k) {
        const SpacePoint<Number>& spoke = sample.spokes[k];
        const Number beside = spoke.dot(normal);
        moment += Number(sample.weights[k]) * (spoke.squaredNorm() - beside * beside);
    }
    // What is not a small correction is not an arc: leave it.
    if (still_number(moment) < 0.0) return sample.point;
    SpacePoint<Number> outward = sample.point - centre;
    outward -= normal * normal.dot(outward);
    const Number distance = outward.norm();
    if (still_number(distance) < 1e-300) return sample.point;
    const Number lift = moment / (sqrt(distance * distance + moment) + distance);  // sqrt(d^2 + m) - d
    return sample.point + outward * Number(lift / distance);
}

MeasuredCircle<double> fit_smooth(StripSamples<double> piece) {
    std::vector<Vec3> points(piece.size());
    for (std::size_t i = 0; i < piece.size(); ++i) points[i] = piece[i].point;
    CircleFit fit = fit_circle(points);
    // Each round shrinks the error by sagitta / radius, about 1/500 for elements of 10 degrees; by less where
    // the points hardly leave a line, so that little holds the plane.
    for (int round = 0; round < most_rounds && fit.valid && fit.curvature > flat_below; ++round) {
        const double before = fit.curvature;
        const Vec3 centre = fit.centre();
        for (std::size_t i = 0; i < piece.size(); ++i)
            points[i] = on_smooth_line(piece[i], centre, fit.normal);
        fit = fit_circle(points);
        if (std::abs(fit.curvature - before) <= 1e-13 * before) break;
    }
    return {fit.curvature, fit.centre(), fit.normal, fit};
}

/// The same with rates. Those of the smooth points depend on that of the circle through them: by rounds too.
MeasuredCircle<MovingNumber> fit_smooth(StripSamples<MovingNumber> piece) {
    std::vector<StripSample<double>> at_rest(piece.size());
    for (std::size_t i = 0; i < piece.size(); ++i) {
        at_rest[i].point = still_point(piece[i].point);
        at_rest[i].weights = piece[i].weights;
        for (int k = 0; k < 3; ++k) at_rest[i].spokes[k] = still_point(piece[i].spokes[k]);
    }
    const CircleFit fit = fit_smooth(StripSamples<double>(at_rest)).fit;
    CircleRate rate;
    if (fit.valid && fit.curvature > flat_below) {
        std::vector<Vec3> points(piece.size());
        std::vector<Vec3> velocities(piece.size());
        for (int round = 0; round < most_rounds; ++round) {
            const double before = rate.curvature;
            for (std::size_t i = 0; i < piece.size(); ++i) {
                const SpacePoint<MovingNumber> point = on_smooth_line(
                    piece[i], with_rate(fit.centre(), rate.centre), with_rate(fit.normal, rate.normal));
                points[i] = still_point(point);
                velocities[i] = rates_of(point);
            }
            rate = circle_rate(fit, points, velocities);
            if (std::abs(rate.curvature - before) <= 1e-13 * std::abs(before)) break;
        }
    }
    return {with_rate(fit.curvature, rate.curvature), with_rate(fit.centre(), rate.centre),
            with_rate(fit.normal, rate.normal), fit};
}

/// Normal curvature from the curvature of the line by Meusnier's theorem: the part of the direction to the
/// centre that lies along the normal n, the rest lies along the binormal n x t. Dividing by both together
/// takes out the tilt of the triangles along the line; the means with sign take out the tilt across.
template <class Number>
Number normal_curvature(const MeasuredCircle<Number>& circle, StripSamples<Number> piece) {
    using std::sqrt;
    Number along_normal(0.0);
    Number along_binormal(0.0);
    const bool curved = circle.fit.curvature > flat_below;
    for (std::size_t i = 0; i < piece.size(); ++i) {
        SpacePoint<Number> inward = circle.fit.inward.template cast<Number>();
        if (curved) inward = (circle.centre - piece[i].point).normalized();
        const SpacePoint<Number> tangent =
            (piece[i].deformation * direction(piece, i).template cast<Number>()).normalized();
        along_normal += inward.dot(piece[i].normal);
        along_binormal += inward.dot(piece[i].normal.cross(tangent));
    }
    const Number both = sqrt(along_normal * along_normal + along_binormal * along_binormal);
    // The centre on the front side (along n) means that the front is concave: negative.
    return still_number(both) > 0.0 ? Number(-circle.curvature * along_normal / both) : Number(0.0);
}

/// Length-weighted sums over the pieces of a strip.
template <class Number>
struct StripSums {
    Number curvature = Number(0.0);
    double square_distance = 0.0;
    double fitted_length = 0.0;
    Number released = Number(0.0);
    double printed = 0.0;
    bool curved = true;  ///< no piece is a line
};

template <class Number>
void add_line(StripSamples<Number> line, StripSums<Number>& sums) {
    for (std::size_t i = 1; i < line.size(); ++i) {
        const Vec2 step = line[i].layout - line[i - 1].layout;
        sums.printed += step.norm();
        for (const std::size_t end : {i - 1, i})
            sums.released += Number(0.5) * (line[end].deformation * step.template cast<Number>()).norm();
    }
    for (const StripSamples<Number> piece : nearly_straight_pieces(line)) {
        const MeasuredCircle<Number> circle = fit_smooth(piece);
        const double length = printed_length(piece);
        if (!circle.fit.valid || !(length > 0.0)) continue;
        sums.curvature += Number(length) * normal_curvature(circle, piece);
        sums.square_distance += length * circle.fit.rms * circle.fit.rms;
        sums.fitted_length += length;
        sums.curved = sums.curved && circle.fit.curvature > flat_below;
    }
}

template <class Number, class Positions>
StripSums<Number> measure_strip(const PrintMesh& layout, const MeshedStrip& strip, const Positions& shape) {
    StripSums<Number> sums;
    for (const std::vector<MeshPoint>& centreline : strip.centreline) {
        std::vector<StripSample<Number>> line;
        line.reserve(centreline.size());
        for (const MeshPoint& at : centreline) {
            if (at.triangle >= 0) line.push_back(sample_at<Number>(layout, shape, at));
        }
        if (line.size() > 1) add_line(StripSamples<Number>(line), sums);
    }
    return sums;
}

}  // namespace

std::vector<StripMetrics> measure_strips(const PrintMesh& layout, std::span<const Vec3> shape) {
    std::vector<StripMetrics> metrics;
    metrics.reserve(layout.strips.size());
    for (const MeshedStrip& strip : layout.strips) {
        const StripSums<double> sums = measure_strip<double>(layout, strip, StillPositions{shape});
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

std::vector<StripRates> strip_rates(const PrintMesh& layout, std::span<const Vec3> shape,
                                    std::span<const Vec3> velocities) {
    std::vector<StripRates> rates;
    rates.reserve(layout.strips.size());
    for (const MeshedStrip& strip : layout.strips) {
        const StripSums<MovingNumber> sums =
            measure_strip<MovingNumber>(layout, strip, MovingPositions{shape, velocities});
        const double curvature = sums.curvature.derivatives()[0] / sums.fitted_length;
        rates.push_back({.curvature = sums.curved ? curvature : std::numeric_limits<double>::quiet_NaN(),
                         .stretch = sums.released.derivatives()[0] / sums.printed});
    }
    return rates;
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
