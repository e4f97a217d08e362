#include "ruche/study/scan/creases.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <tuple>

namespace ruche {
namespace {

struct HalfEdge {
    std::array<Vec3, 2> ends;  // the lesser first
    Vec3 normal;               // of its triangle
};

bool less(const Vec3& a, const Vec3& b) {
    return std::tie(a.x(), a.y(), a.z()) < std::tie(b.x(), b.y(), b.z());
}

}  // namespace

std::vector<Corners> creases_of(const std::vector<Corners>& surface, double angle) {
    std::vector<HalfEdge> half_edges;
    for (const Corners& t : surface) {
        if (!t[0].allFinite() || !t[1].allFinite() || !t[2].allFinite()) continue;
        const Vec3 normal = (t[1] - t[0]).cross(t[2] - t[0]).normalized();
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3& a = t[k];
            const Vec3& b = t[(k + 1) % 3];
            half_edges.push_back(less(a, b) ? HalfEdge{{a, b}, normal} : HalfEdge{{b, a}, normal});
        }
    }
    const auto order = [](const HalfEdge& a, const HalfEdge& b) {
        return a.ends[0] != b.ends[0] ? less(a.ends[0], b.ends[0]) : less(a.ends[1], b.ends[1]);
    };
    std::sort(half_edges.begin(), half_edges.end(), order);
    const double flat = std::cos(angle);
    std::vector<Corners> creases;
    for (auto first = half_edges.begin(); first != half_edges.end();) {
        const auto last = std::upper_bound(first, half_edges.end(), *first, order);
        // Neighbours may be turned opposite ways, as the upright sides of a print are.
        const bool smooth = last - first == 2 && std::abs(first->normal.dot((first + 1)->normal)) >= flat;
        if (!smooth) creases.push_back({first->ends[0], first->ends[1], first->ends[1]});
        first = last;
    }
    return creases;
}

}  // namespace ruche
