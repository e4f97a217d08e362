#include "ruche/pattern/centreline.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "ruche/geometry/polyline.hpp"

namespace ruche {

namespace {

constexpr int samples = 128;        // around a border
constexpr int steps = samples / 2;  // across from end to end
constexpr double far_away = std::numeric_limits<double>::infinity();

/// A border by 128 evenly spaced points, seen as two sides between two ends.
struct Sides {
    const Polyline& border;
    int start;
    int end;

    Vec2 at(double place) const {
        const double wrapped = place - samples * std::floor(place / samples);
        const int i = static_cast<int>(wrapped) % samples;
        const double t = wrapped - std::floor(wrapped);
        return (1.0 - t) * border[i] + t * border[(i + 1) % samples];
    }
    int forward() const { return (end - start + samples) % samples; }
    Vec2 one(double t) const { return at(start + t * forward()); }
    Vec2 other(double t) const { return at(start - t * (samples - forward())); }

    // The mean distance between the sides; long sides paired well are close to each other.
    double mean_gap() const {
        double sum = 0.0;
        for (int k = 1; k < steps; ++k) {
            const double t = static_cast<double>(k) / steps;
            sum += (one(t) - other(t)).norm();
        }
        return sum / (steps - 1);
    }
};

// The two ends that make the sides closest to each other: first opposite ends, then each end in turn.
Sides best_sides(const Polyline& border) {
    Sides best{border, 0, samples / 2};
    double smallest = far_away;
    const auto consider = [&](int start, int end) {
        const Sides sides{border, start, end};
        if (sides.forward() < samples / 4 || sides.forward() > samples - samples / 4) return;
        const double gap = sides.mean_gap();
        if (gap < smallest * (1.0 - 1e-9)) {
            smallest = gap;
            best.start = start;
            best.end = end;
        }
    };
    for (int i = 0; i < samples / 2; ++i) consider(i, i + samples / 2);
    for (int round = 0; round < 2; ++round) {
        const int start = best.start;
        for (int i = 0; i < samples; ++i) consider(start, i);
        const int end = best.end;
        for (int i = 0; i < samples; ++i) consider(i, end);
    }
    return best;
}

Polyline between(const Sides& sides) {
    Polyline line;
    for (int k = 0; k <= steps; ++k) {
        const double t = static_cast<double>(k) / steps;
        line.emplace_back(0.5 * (sides.one(t) + sides.other(t)));
    }
    return line;
}

Vec2 nearest_on(const Polyline& loop, const Vec2& p) {
    Vec2 nearest = p;
    double smallest = far_away;
    for (std::size_t i = 0; i < loop.size(); ++i) {
        const Vec2& a = loop[i];
        const Vec2 along = loop[(i + 1) % loop.size()] - a;
        const double square = along.squaredNorm();
        const double t = square > 0.0 ? std::clamp((p - a).dot(along) / square, 0.0, 1.0) : 0.0;
        const Vec2 q = a + t * along;
        const double d = (q - p).squaredNorm();
        if (d < smallest) {
            smallest = d;
            nearest = q;
        }
    }
    return nearest;
}

// A hole that takes up much of the area makes a ring of the region; a small one is only a hole in a strip.
bool is_ring(const Polygon& polygon) {
    const double whole = area({{polygon.outer, {}}});
    return area({polygon}) < 0.8 * whole;
}

Polyline ring_midline(const Polygon& ring) {
    Polyline line;
    for (const Vec2& p : resample(ring.holes[0], true, samples)) {
        line.emplace_back(0.5 * (p + nearest_on(ring.outer, p)));
    }
    line.push_back(line.front());
    return line;
}

double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

// Where (0 to 1) the segment from a to b crosses the borders of the region.
std::vector<double> crossings(const Vec2& a, const Vec2& b, const Region& region) {
    std::vector<double> at = {0.0, 1.0};
    const Vec2 along = b - a;
    const Vec2 low = a.cwiseMin(b);
    const Vec2 high = a.cwiseMax(b);
    const auto cut = [&](const Polyline& loop) {
        for (std::size_t i = 0; i < loop.size(); ++i) {
            const Vec2& c = loop[i];
            const Vec2& d = loop[(i + 1) % loop.size()];
            if (std::min(c.x(), d.x()) > high.x() || std::max(c.x(), d.x()) < low.x()) continue;
            if (std::min(c.y(), d.y()) > high.y() || std::max(c.y(), d.y()) < low.y()) continue;
            const double turn = cross(along, d - c);
            if (turn == 0.0) continue;
            const double t = cross(c - a, d - c) / turn;
            const double s = cross(c - a, along) / turn;
            if (t > 0.0 && t < 1.0 && s >= 0.0 && s <= 1.0) at.push_back(t);
        }
    };
    for (const Polygon& polygon : region) {
        cut(polygon.outer);
        for (const Polyline& hole : polygon.holes) cut(hole);
    }
    std::sort(at.begin(), at.end());
    return at;
}

}  // namespace

Polyline midline(const Polygon& polygon) {
    if (polygon.outer.size() < 3) return {};
    if (polygon.holes.size() == 1 && is_ring(polygon)) return ring_midline(polygon);
    const Polyline border = resample(polygon.outer, true, samples);
    return between(best_sides(border));
}

std::vector<Polyline> cut_to_region(const std::vector<Polyline>& lines, const Region& region,
                                    double shortest) {
    std::vector<Polyline> parts;
    for (const Polyline& line : lines) {
        const std::size_t before = parts.size();
        Polyline part;
        const auto finish = [&] {
            if (length(part) >= shortest) parts.push_back(part);
            part.clear();
        };
        for (std::size_t i = 1; i < line.size(); ++i) {
            const Vec2& a = line[i - 1];
            const Vec2& b = line[i];
            if (a == b) continue;
            const std::vector<double> at = crossings(a, b, region);
            for (std::size_t k = 1; k < at.size(); ++k) {
                const double middle = 0.5 * (at[k - 1] + at[k]);
                if (at[k] <= at[k - 1]) continue;
                if (!contains(region, a + middle * (b - a))) {
                    finish();
                    continue;
                }
                if (part.empty()) part.emplace_back(a + at[k - 1] * (b - a));
                // The exact end point, so that neighbouring segments join.
                part.emplace_back(at[k] == 1.0 ? b : Vec2(a + at[k] * (b - a)));
            }
        }
        finish();
        // A closed line that starts inside: its last and first parts are one.
        if (parts.size() > before + 1 && line.front() == line.back() &&
            parts[before].front() == line.front() && parts.back().back() == line.back()) {
            Polyline joined = std::move(parts.back());
            parts.pop_back();
            joined.insert(joined.end(), parts[before].begin() + 1, parts[before].end());
            parts[before] = std::move(joined);
        }
    }
    return parts;
}

}  // namespace ruche
