#include "ruche/pattern/centreline.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "ruche/geometry/polyline.hpp"

namespace ruche {

namespace {

constexpr int coarse = 128;        // points around a border while looking for its ends
constexpr int finest = 2048;       // at most so many for the line itself
constexpr double rounding = 1e-9;  // mm: shorter pieces between crossings are none
constexpr double far_away = std::numeric_limits<double>::infinity();

/// A border by evenly spaced points, seen as two sides between two of them, the ends.
struct Sides {
    const Polyline& border;
    int start;
    int end;

    int count() const { return static_cast<int>(border.size()); }
    int steps() const { return count() / 2; }
    int forward() const { return (end - start + count()) % count(); }

    Vec2 at(double place) const {
        const double wrapped = place - count() * std::floor(place / count());
        const int i = static_cast<int>(wrapped) % count();
        const double t = wrapped - std::floor(wrapped);
        return (1.0 - t) * border[i] + t * border[(i + 1) % count()];
    }
    Vec2 one(double t) const { return at(start + t * forward()); }
    Vec2 other(double t) const { return at(start - t * (count() - forward())); }

    // The mean distance between the sides; long sides paired well are close to each other.
    double mean_gap() const {
        double sum = 0.0;
        for (int k = 1; k < steps(); ++k) {
            const double t = static_cast<double>(k) / steps();
            sum += (one(t) - other(t)).norm();
        }
        return sum / (steps() - 1);
    }
};

/// Moves the ends to where the sides are closest to each other.
class EndSearch {
  public:
    explicit EndSearch(const Sides& first) : best_(first), smallest_(first.mean_gap()) {}

    void consider(int start, int end) {
        const int count = best_.count();
        const Sides sides{best_.border, (start + count) % count, (end + count) % count};
        if (sides.forward() < count / 4 || sides.forward() > count - count / 4) return;
        const double gap = sides.mean_gap();
        if (gap >= smallest_ * (1.0 - 1e-9)) return;
        smallest_ = gap;
        best_.start = sides.start;
        best_.end = sides.end;
    }

    // Each end in turn, up to `reach` points away from where it is.
    void move_ends(int reach) {
        for (int round = 0; round < 2; ++round) {
            const int start = best_.start;
            const int end = best_.end;
            for (int i = -reach; i < reach; ++i) consider(start, end + i);
            const int moved = best_.end;
            for (int i = -reach; i < reach; ++i) consider(start + i, moved);
        }
    }

    int start() const { return best_.start; }
    int end() const { return best_.end; }
    const Sides& best() const { return best_; }

  private:
    Sides best_;
    double smallest_;
};

Polyline between(const Sides& sides) {
    Polyline line;
    for (int k = 0; k <= sides.steps(); ++k) {
        const double t = static_cast<double>(k) / sides.steps();
        line.emplace_back(0.5 * (sides.one(t) + sides.other(t)));
    }
    return line;
}

// How many points at an end of the line lie in the strip's cap, where its sides do not face each other yet:
// within half a width, and on up to a width while the sides still diverge.
int points_in_cap(const Sides& sides, const Polyline& line, double width, bool from_end) {
    int k = 0;
    for (; k < sides.steps() / 4; ++k) {
        const double t = static_cast<double>(from_end ? sides.steps() - k : k) / sides.steps();
        const Vec2& here = from_end ? line[line.size() - 1 - k] : line[k];
        const double distance = (here - (from_end ? line.back() : line.front())).norm();
        if (distance > width) break;
        if (distance > 0.5 * width && (sides.one(t) - sides.other(t)).norm() > 0.98 * width) break;
    }
    return k;
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
    for (const Vec2& p : resample(ring.holes[0], true, coarse)) {
        line.emplace_back(0.5 * (p + nearest_on(ring.outer, p)));
    }
    line.push_back(line.front());
    return line;
}

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
            if (t > 0.0 && t < 1.0 && s >= -rounding && s <= 1.0 + rounding) at.push_back(t);
        }
    };
    for (const Polygon& polygon : region) {
        cut(polygon.outer);
        for (const Polyline& hole : polygon.holes) cut(hole);
    }
    std::sort(at.begin(), at.end());
    return at;
}

constexpr std::size_t few = 3;  // points: directions are taken over so many, single steps are noisy

// Moves every point to the middle of the cross-section through it, where the border is near on both sides.
Polyline recentred(const Polyline& line, const Polygon& strip, double width) {
    Polyline result = line;
    for (std::size_t i = 0; i < line.size(); ++i) {
        const Vec2 along = line[std::min(i + few, line.size() - 1)] - line[i < few ? 0 : i - few];
        if (along.norm() < rounding || !contains({strip}, line[i])) continue;
        const Vec2 across = Vec2(-along.y(), along.x()).normalized() * (1.5 * width);
        const double left = crossings(line[i], line[i] + across, {strip})[1];
        const double right = crossings(line[i], line[i] - across, {strip})[1];
        if (left < 1.0 && right < 1.0) result[i] += 0.5 * (left - right) * across;
    }
    return result;
}

// The line with its ends inside the strip's caps, where the sides do not face each other, replaced by
// straight ones up to the border.
Polyline with_straight_ends(const Sides& sides, const Polygon& strip) {
    const Polyline line = between(sides);
    const double width = strip_width(strip);
    const int first = points_in_cap(sides, line, width, false);
    const int last = static_cast<int>(line.size()) - points_in_cap(sides, line, width, true);
    Polyline inner(line.begin() + first, line.begin() + last);
    const auto extended = [&](const Vec2& end, const Vec2& before) -> Vec2 {
        const Vec2 ahead = (end - before).normalized() * (2.0 * width);
        const double reach = crossings(end, end + ahead, {strip})[1];
        return reach < 1.0 ? Vec2(end + reach * ahead) : end;
    };
    if (inner.size() <= few) return line;
    for (int round = 0; round < 2; ++round) inner = recentred(inner, strip, width);
    const Vec2 start = extended(inner.front(), inner[few]);
    const Vec2 end = extended(inner.back(), inner[inner.size() - 1 - few]);
    inner.insert(inner.begin(), start);
    inner.push_back(end);
    return inner;
}

// First on few points over all pairs of opposite ends, then on points a quarter of the width apart.
Polyline strip_midline(const Polygon& strip) {
    const Polyline rough = resample(strip.outer, true, coarse);
    EndSearch search({rough, 0, coarse / 2});
    for (int i = 1; i < coarse / 2; ++i) search.consider(i, i + coarse / 2);
    search.move_ends(coarse / 2);
    const double wanted = length(strip.outer, true) / (0.25 * strip_width(strip));
    const int finer = static_cast<int>(std::clamp(std::ceil(wanted / coarse), 1.0, 1.0 * finest / coarse));
    const Polyline fine = resample(strip.outer, true, finer * coarse);
    EndSearch refined({fine, finer * search.start(), finer * search.end()});
    refined.move_ends(finer);
    return with_straight_ends(refined.best(), strip);
}

}  // namespace

Polyline midline(const Polygon& polygon) {
    if (polygon.outer.size() < 3) return {};
    if (polygon.holes.size() == 1 && is_ring(polygon)) return ring_midline(polygon);
    return strip_midline({polygon.outer, {}});
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
                if ((at[k] - at[k - 1]) * (b - a).norm() < rounding) continue;
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
