#include "ruche/statics/starts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace ruche {
namespace {

double smallest_edge(const TriangleMesh& mesh) {
    double smallest = infinity;
    for (const Triangle& tri : mesh.triangles) {
        for (int i = 0; i < 3; ++i) {
            smallest = std::min(smallest, (mesh.vertices[tri[i]] - mesh.vertices[tri[(i + 1) % 3]]).norm());
        }
    }
    return smallest;
}

/// The smallest and the largest coordinate of the layout along a direction.
std::array<double, 2> extent(const TriangleMesh& mesh, const Vec2& direction) {
    std::array<double, 2> range = {infinity, -infinity};
    for (const Vec2& p : mesh.vertices) {
        range[0] = std::min(range[0], p.dot(direction));
        range[1] = std::max(range[1], p.dot(direction));
    }
    return range;
}

struct Wave {
    Vec2 number;  // of the wave, rad/mm
    double phase;
};

std::array<Wave, 4> random_waves(int seed, double diameter) {
    std::array<Wave, 4> waves;
    int drawn = 0;
    for (Wave& wave : waves) {
        const double direction = std::numbers::pi * noise(seed, drawn++);
        const double length = diameter * std::exp2(noise(seed, drawn++));
        wave.number = 2.0 * std::numbers::pi / length * Vec2(std::cos(direction), std::sin(direction));
        wave.phase = std::numbers::pi * noise(seed, drawn++);
    }
    return waves;
}

}  // namespace

double noise(int seed, int index) {
    std::uint64_t z = (static_cast<std::uint64_t>(seed) << 40U) +
                      (static_cast<std::uint64_t>(index) + 1) * 0x9e3779b97f4a7c15ULL;
    z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27U)) * 0x94d049bb133111ebULL;
    z ^= z >> 31U;
    return static_cast<double>(z >> 11U) * 0x1.0p-52 - 1.0;
}

Eigen::VectorXd noisy_start(const Model& model, int seed, double size_mm) {
    Eigen::VectorXd x = model.initial();
    const double size = std::min(size_mm, 0.01 * smallest_edge(model.input().mesh));
    for (int i = 0; i < 3 * model.vertex_count(); ++i) x[i] += size * noise(seed, i);
    return x;
}

Eigen::VectorXd rolled_start(const Model& model, const Roll& roll) {
    const TriangleMesh& mesh = model.input().mesh;
    const Vec2 along(std::cos(roll.direction), std::sin(roll.direction));
    const Vec2 across(-along.y(), along.x());
    const auto [low, high] = extent(mesh, along);
    Eigen::VectorXd x = model.initial();
    if (roll.turn == 0.0) return x;
    const double radius = (high - low) / roll.turn;
    for (int v = 0; v < model.vertex_count(); ++v) {
        const Vec2& p = mesh.vertices[v];
        const double angle = (p.dot(along) - 0.5 * (low + high)) / radius;
        const Vec2 flat = radius * std::sin(angle) * along + p.dot(across) * across;
        x.segment<3>(3 * static_cast<Eigen::Index>(v)) << flat, radius * (std::cos(angle) - 1.0);
    }
    return x;
}

Eigen::VectorXd wavy_start(const Model& model, int seed) {
    constexpr double steepest = 0.6;
    const TriangleMesh& mesh = model.input().mesh;
    const auto [left, right] = extent(mesh, Vec2::UnitX());
    const auto [bottom, top] = extent(mesh, Vec2::UnitY());
    const std::array<Wave, 4> waves = random_waves(seed, std::hypot(right - left, top - bottom));
    double slope = 0.0;
    for (const Vec2& p : mesh.vertices) {
        Vec2 gradient = Vec2::Zero();
        for (const Wave& wave : waves) gradient += std::cos(wave.number.dot(p) + wave.phase) * wave.number;
        slope = std::max(slope, gradient.norm());
    }
    const double height = steepest / slope;
    const double contraction = std::sqrt(1.0 - steepest * steepest);  // metric: c^2 I + slope slope^T <= I
    Eigen::VectorXd x = model.initial();
    for (int v = 0; v < model.vertex_count(); ++v) {
        double z = 0.0;
        for (const Wave& wave : waves) z += height * std::sin(wave.number.dot(mesh.vertices[v]) + wave.phase);
        x.segment<3>(3 * static_cast<Eigen::Index>(v)) << contraction * mesh.vertices[v], z;
    }
    return x;
}

}  // namespace ruche
