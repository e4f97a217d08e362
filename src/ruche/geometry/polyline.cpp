#include "ruche/geometry/polyline.hpp"

#include <algorithm>
#include <utility>

namespace ruche {

double length(const Polyline& line, bool closed) {
    double sum = 0.0;
    for (std::size_t i = 1; i < line.size(); ++i) sum += (line[i] - line[i - 1]).norm();
    if (closed && line.size() > 1) sum += (line.front() - line.back()).norm();
    return sum;
}

double distance_to_segment(const Vec2& point, const Vec2& a, const Vec2& b) {
    const Vec2 along = b - a;
    const double square = along.squaredNorm();
    const double t = square > 0.0 ? std::clamp((point - a).dot(along) / square, 0.0, 1.0) : 0.0;
    return (point - a - t * along).norm();
}

Polyline simplify(const Polyline& line, bool closed, double tolerance) {
    if (line.size() < 3) return line;
    Polyline points = line;
    if (closed) points.push_back(line.front());
    std::vector<char> keep(points.size(), 0);
    keep.front() = keep.back() = 1;
    // A stack, not recursion: a drawing may hold a chain of any length.
    std::vector<std::pair<std::size_t, std::size_t>> open = {{0, points.size() - 1}};
    bool whole_loop = closed;
    while (!open.empty()) {
        const auto [first, last] = open.back();
        open.pop_back();
        double farthest = -1.0;
        std::size_t at = first;
        for (std::size_t i = first + 1; i < last; ++i) {
            const double d = distance_to_segment(points[i], points[first], points[last]);
            if (d > farthest) {
                farthest = d;
                at = i;
            }
        }
        if (at == first || (farthest <= tolerance && !whole_loop)) continue;
        whole_loop = false;
        keep[at] = 1;
        open.emplace_back(first, at);
        open.emplace_back(at, last);
    }
    Polyline result;
    for (std::size_t i = 0; i < line.size(); ++i) {
        if (keep[i]) result.push_back(line[i]);
    }
    return result;
}

Polyline resample(const Polyline& line, bool closed, int count) {
    Polyline points = line;
    if (closed && !points.empty()) points.push_back(line.front());
    if (points.size() < 2 || count < 2) return points;
    const double total = length(points);
    const int pieces = closed ? count : count - 1;
    Polyline result;
    double before = 0.0;  // length of the chain up to segment k
    std::size_t k = 0;
    for (int i = 0; i < count; ++i) {
        const double wanted = total * i / pieces;
        double piece = (points[k + 1] - points[k]).norm();
        while (k + 2 < points.size() && before + piece < wanted) {
            before += piece;
            ++k;
            piece = (points[k + 1] - points[k]).norm();
        }
        const double t = piece > 0.0 ? std::clamp((wanted - before) / piece, 0.0, 1.0) : 0.0;
        result.emplace_back(points[k] + t * (points[k + 1] - points[k]));
    }
    return result;
}

}  // namespace ruche
