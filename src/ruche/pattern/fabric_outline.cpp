#include "ruche/pattern/fabric_outline.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "ruche/core/error.hpp"
#include "ruche/geometry/polyline.hpp"

namespace ruche {

namespace {

constexpr double joint = 0.05;             // mm: ends this close go on in each other
constexpr double same = 1e-5;              // relative difference in area of what counts as the same curve
constexpr std::size_t searchable = 20000;  // points: above, a crossing's place is not looked for

struct Loop {
    const Shape* shape = nullptr;
    Polyline points;
    Region region;
};

Place place_of(const Shape& shape, const std::string& file) {
    return {file, shape.line, "element '" + shape.id + "'"};
}

// The first place where two segments of a closed chain that are not neighbours meet.
std::optional<Vec2> crossing(const Polyline& loop) {
    if (loop.size() > searchable) return {};
    const std::size_t count = loop.size();
    for (std::size_t i = 0; i < count; ++i) {
        const Vec2& a = loop[i];
        const Vec2 along = loop[(i + 1) % count] - a;
        for (std::size_t j = i + 2; j < count; ++j) {
            if (i == 0 && j + 1 == count) continue;
            const Vec2& c = loop[j];
            const Vec2 other = loop[(j + 1) % count] - c;
            const double turn = cross(along, other);
            if (turn == 0.0) continue;
            const double t = cross(c - a, other) / turn;
            const double s = cross(c - a, along) / turn;
            if (t >= 0.0 && t <= 1.0 && s >= 0.0 && s <= 1.0) return a + t * along;
        }
    }
    return {};
}

// A simple closed curve is one polygon without holes under both fill rules.
void check_simple(Loop& loop, const std::string& file) {
    loop.region = region_from_loops({&loop.points, 1}, FillRule::nonzero);
    const Region odd = region_from_loops({&loop.points, 1}, FillRule::evenodd);
    const auto single = [](const Region& r) { return r.size() == 1 && r.front().holes.empty(); };
    if (loop.region.empty()) {
        throw InputError(place_of(*loop.shape, file), "the fabric's outline encloses no area",
                         "Draw the outline as a closed curve around the strips.");
    }
    if (single(loop.region) && single(odd) &&
        std::abs(area(loop.region) - area(odd)) <= same * area(loop.region)) {
        return;
    }
    const std::optional<Vec2> at = crossing(loop.points);
    throw InputError(place_of(*loop.shape, file),
                     "the fabric's outline crosses or touches itself" +
                         (at ? fmt::format(" near x = {:.4g}, y = {:.4g} mm", at->x(), at->y()) : ""),
                     "Draw each edge of the fabric as one closed curve without crossings.");
}

// Appends open lines to each other while an end meets another end.
void join_open_lines(std::vector<Loop>& open, std::vector<Loop>& closed, const std::string& file) {
    while (!open.empty()) {
        Loop loop = std::move(open.front());
        open.erase(open.begin());
        bool grew = true;
        while (grew && (loop.points.front() - loop.points.back()).norm() > joint) {
            grew = false;
            for (std::size_t i = 0; i < open.size() && !grew; ++i) {
                Polyline& next = open[i].points;
                const bool forward = (next.front() - loop.points.back()).norm() <= joint;
                if (!forward && (next.back() - loop.points.back()).norm() > joint) continue;
                if (!forward) std::reverse(next.begin(), next.end());
                loop.points.insert(loop.points.end(), next.begin() + 1, next.end());
                open.erase(open.begin() + static_cast<std::ptrdiff_t>(i));
                grew = true;
            }
        }
        const double gap = (loop.points.front() - loop.points.back()).norm();
        if (gap > joint || loop.points.size() < 3) {
            const Vec2& at = loop.points.back();
            throw InputError(
                place_of(*loop.shape, file),
                fmt::format("the fabric's outline is not closed: it ends near x = {:.4g}, y = {:.4g} mm, "
                            "{:.3g} mm from its start",
                            at.x(), at.y(), gap),
                "Close the curve, or draw lines that meet end to end.");
        }
        loop.points.pop_back();
        closed.push_back(std::move(loop));
    }
}

std::vector<Loop> loops_of(const std::vector<const Shape*>& shapes, const std::string& file) {
    std::vector<Loop> closed;
    std::vector<Loop> open;
    for (const Shape* shape : shapes) {
        for (std::size_t i = 0; i < shape->lines.size(); ++i) {
            const Polyline& line = shape->lines[i];
            if (line.size() < 2) continue;
            (shape->closed[i] ? closed : open).push_back({shape, line, {}});
        }
        if (!shape->lines.empty()) continue;
        for (const Polygon& polygon : shape->filled) {
            closed.push_back({shape, polygon.outer, {}});
            for (const Polyline& hole : polygon.holes) closed.push_back({shape, hole, {}});
        }
    }
    join_open_lines(open, closed, file);
    for (Loop& loop : closed) check_simple(loop, file);
    return closed;
}

}  // namespace

Region fabric_outline(const std::vector<const Shape*>& shapes, const std::string& file) {
    std::vector<Loop> loops = loops_of(shapes, file);
    std::stable_sort(loops.begin(), loops.end(),
                     [](const Loop& a, const Loop& b) { return area(a.region) > area(b.region); });
    std::vector<Loop> distinct;
    std::vector<Polyline> borders;
    for (Loop& loop : loops) {
        const double own = area(loop.region);
        bool twice = false;
        for (const Loop& larger : distinct) {
            const double common = area(intersect(loop.region, larger.region));
            if (common <= same * own) continue;
            if (own - common > same * own) {
                throw InputError(
                    place_of(*loop.shape, file),
                    fmt::format("this edge of the fabric crosses the edge '{}'", larger.shape->id),
                    "Edges of the fabric lie inside or outside each other (holes, pieces).");
            }
            twice = twice || area(larger.region) - own <= same * own;
        }
        if (twice) continue;
        borders.push_back(loop.points);
        distinct.push_back(std::move(loop));
    }
    return region_from_loops(borders, FillRule::evenodd);
}

}  // namespace ruche
