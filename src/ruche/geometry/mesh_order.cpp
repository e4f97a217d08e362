#include "ruche/geometry/mesh_order.hpp"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <utility>

namespace ruche {

namespace {

constexpr std::uint32_t bits = 16;

// Distance along the Hilbert curve of order 16 (Hamilton 2006, the planar case).
std::uint64_t hilbert_distance(std::uint32_t x, std::uint32_t y) {
    std::uint64_t distance = 0;
    for (std::uint32_t s = 1U << (bits - 1); s > 0; s /= 2) {
        const bool right = (x & s) != 0;
        const bool upper = (y & s) != 0;
        distance = 4 * distance + (right ? (upper ? 2U : 3U) : (upper ? 1U : 0U));
        if (!upper) {
            if (right) {
                x = ~x;
                y = ~y;
            }
            std::swap(x, y);
        }
    }
    return distance;
}

}  // namespace

std::vector<int> spatial_order(const TriangleMesh& mesh) {
    std::vector<int> order(mesh.triangles.size());
    std::iota(order.begin(), order.end(), 0);
    if (order.empty()) return order;
    std::vector<Vec2> centre;
    centre.reserve(order.size());
    for (const Triangle& t : mesh.triangles) {
        centre.emplace_back((mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3.0);
    }
    Vec2 low = centre[0];
    Vec2 high = centre[0];
    for (const Vec2& c : centre) {
        low = low.cwiseMin(c);
        high = high.cwiseMax(c);
    }
    const double scale = ((1U << bits) - 1) / std::max((high - low).maxCoeff(), 1e-300);
    std::vector<std::uint64_t> place;
    for (const Vec2& c : centre) {
        const Vec2 cell = (c - low) * scale;
        place.push_back(
            hilbert_distance(static_cast<std::uint32_t>(cell.x()), static_cast<std::uint32_t>(cell.y())));
    }
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return place[a] < place[b]; });
    return order;
}

TriangleMesh reordered(const TriangleMesh& mesh, const std::vector<int>& order) {
    TriangleMesh result;
    std::vector<int> number(mesh.vertices.size(), -1);
    for (const int t : order) {
        Triangle triangle = mesh.triangles[t];
        for (int& v : triangle) {
            if (number[v] < 0) {
                number[v] = result.vertex_count();
                result.vertices.push_back(mesh.vertices[v]);
            }
            v = number[v];
        }
        result.triangles.push_back(triangle);
    }
    return result;
}

}  // namespace ruche
