#include "ruche/study/sensitivity/shape_measures.hpp"

#include <Eigen/Dense>
#include <cmath>
#include <limits>

#include "ruche/output/metrics.hpp"

namespace ruche {
namespace {

constexpr double no_derivative = std::numeric_limits<double>::quiet_NaN();

/// Shares of the layout's area.
std::vector<double> vertex_weights(const TriangleMesh& mesh) {
    std::vector<double> weights(mesh.vertices.size(), 0.0);
    double whole = 0.0;
    for (int t = 0; t < mesh.triangle_count(); ++t) {
        const double area = layout_area(mesh, t);
        whole += area;
        for (const int v : mesh.triangles[static_cast<std::size_t>(t)])
            weights[static_cast<std::size_t>(v)] += area / 3.0;
    }
    for (double& weight : weights) weight /= whole;
    return weights;
}

}  // namespace

ShapeMeasures::ShapeMeasures(const PrintMesh& layout, std::span<const Vec3> shape)
    : layout_(layout), shape_(shape), weights_(vertex_weights(layout.mesh)) {
    const std::vector<StripMetrics> strips = measure_strips(layout, shape);
    double printed = 0.0;
    for (const StripMetrics& strip : strips) {
        const bool measured = std::isfinite(strip.curvature) && std::isfinite(strip.stretch);
        strip_weights_.push_back(measured ? strip.printed_length : 0.0);
        strip_curvatures_.push_back(measured ? strip.curvature : 0.0);
        printed += strip_weights_.back();
    }
    double curvature = 0.0;
    double stretch = 0.0;
    for (std::size_t i = 0; i < strips.size() && printed > 0.0; ++i) {
        if (strip_weights_[i] == 0.0) continue;
        strip_weights_[i] /= printed;
        curvature += strip_weights_[i] * std::abs(strip_curvatures_[i]);
        stretch += strip_weights_[i] * strips[i].stretch;
    }
    measure_extents();
    has_strips_ = printed > 0.0;
    if (has_strips_) {
        values_.push_back({"mean_curvature", "1/mm", curvature});
        values_.push_back({"mean_stretch", "", stretch});
    }
    values_.push_back({"area", "mm^2", measure_shape(layout, shape).area});
    values_.push_back({"length", "mm", extents_[0].size});
    values_.push_back({"width", "mm", extents_[1].size});
    values_.push_back({"height", "mm", extents_[2].size});
    for (std::size_t i = 0; i < strips.size(); ++i) {
        if (strip_weights_[i] > 0.0)
            values_.push_back({"curvature." + strips[i].id, "1/mm", strip_curvatures_[i]});
    }
}

void ShapeMeasures::measure_extents() {
    for (std::size_t v = 0; v < shape_.size(); ++v) mean_ += weights_[v] * shape_[v];
    Mat3 moments = Mat3::Zero();
    for (std::size_t v = 0; v < shape_.size(); ++v)
        moments += weights_[v] * (shape_[v] - mean_) * (shape_[v] - mean_).transpose();
    const Eigen::SelfAdjointEigenSolver<Mat3> eigen(moments);  // ascending
    for (int i = 0; i < 3; ++i) {
        Extent& extent = extents_[static_cast<std::size_t>(i)];
        extent.axis = eigen.eigenvectors().col(2 - i);
        extent.spread = eigen.eigenvalues()[2 - i];
        for (std::size_t v = 0; v < shape_.size(); ++v) {
            const auto place = [&](std::size_t vertex) { return extent.axis.dot(shape_[vertex]); };
            if (place(v) < place(static_cast<std::size_t>(extent.low))) extent.low = static_cast<int>(v);
            if (place(v) > place(static_cast<std::size_t>(extent.high))) extent.high = static_cast<int>(v);
        }
        extent.size = extent.axis.dot(shape_[static_cast<std::size_t>(extent.high)] -
                                      shape_[static_cast<std::size_t>(extent.low)]);
    }
}

std::array<double, 3> ShapeMeasures::extent_rates(std::span<const Vec3> velocities) const {
    constexpr double same_spread = 1e-3;  // of the largest: closer moments leave the axes to chance
    Vec3 mean_rate = Vec3::Zero();
    for (std::size_t v = 0; v < shape_.size(); ++v) mean_rate += weights_[v] * velocities[v];
    Mat3 half = Mat3::Zero();
    for (std::size_t v = 0; v < shape_.size(); ++v)
        half += weights_[v] * (velocities[v] - mean_rate) * (shape_[v] - mean_).transpose();
    const Mat3 moments_rate = half + half.transpose();
    std::array<double, 3> rates;
    for (std::size_t i = 0; i < 3; ++i) {
        const Extent& extent = extents_[i];
        Vec3 axis_rate = Vec3::Zero();
        bool unique = true;
        for (const Extent& other : extents_) {
            if (&other == &extent) continue;
            const double gap = extent.spread - other.spread;
            unique = unique && std::abs(gap) > same_spread * extents_[0].spread;
            axis_rate += other.axis * (other.axis.dot(moments_rate * extent.axis) / gap);
        }
        const auto low = static_cast<std::size_t>(extent.low);
        const auto high = static_cast<std::size_t>(extent.high);
        rates[i] = unique ? axis_rate.dot(shape_[high] - shape_[low]) +
                                extent.axis.dot(velocities[high] - velocities[low])
                          : no_derivative;
    }
    return rates;
}

double ShapeMeasures::area_rate(std::span<const Vec3> velocities) const {
    double rate = 0.0;
    for (const Triangle& tri : layout_.mesh.triangles) {
        const auto edge = [&](std::span<const Vec3> of, int end) -> Vec3 {
            return of[static_cast<std::size_t>(tri[static_cast<std::size_t>(end)])] -
                   of[static_cast<std::size_t>(tri[0])];
        };
        const Vec3 normal = edge(shape_, 1).cross(edge(shape_, 2)).normalized();
        rate += 0.5 * normal.dot(edge(velocities, 1).cross(edge(shape_, 2)) +
                                 edge(shape_, 1).cross(edge(velocities, 2)));
    }
    return rate;
}

std::vector<double> ShapeMeasures::rates(std::span<const Vec3> velocities) const {
    const std::vector<StripRates> strips = strip_rates(layout_, shape_, velocities);
    const std::array<double, 3> extents = extent_rates(velocities);
    double curvature = 0.0;
    double stretch = 0.0;
    std::vector<double> rates;
    for (std::size_t i = 0; i < strips.size(); ++i) {
        if (strip_weights_[i] == 0.0) continue;
        const double sign = strip_curvatures_[i] < 0.0 ? -1.0 : 1.0;
        curvature += sign * strip_weights_[i] * strips[i].curvature;
        stretch += strip_weights_[i] * strips[i].stretch;
    }
    if (has_strips_) rates = {curvature, stretch};
    rates.insert(rates.end(), {area_rate(velocities), extents[0], extents[1], extents[2]});
    for (std::size_t i = 0; i < strips.size(); ++i) {
        if (strip_weights_[i] > 0.0) rates.push_back(strips[i].curvature);
    }
    return rates;
}

}  // namespace ruche
