#include "ruche/pattern/svg_stroke.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <Eigen/LU>

#include "ruche/pattern/svg_transform.hpp"

namespace ruche::svg {

namespace {

constexpr double hair = 1e-6;  // mm, the grid of the polygon operations

/// Walks along a line and cuts it where the dash pattern changes.
class Dasher {
  public:
    Dasher(const std::vector<double>& dashes, double offset) : dashes_(dashes) {
        const double period = std::accumulate(dashes.begin(), dashes.end(), 0.0);
        double rest = std::fmod(offset, period);
        if (rest < 0.0) rest += period;
        while (rest >= dashes_[index_] && rest > 0.0) {
            rest -= dashes_[index_];
            index_ = (index_ + 1) % dashes_.size();
        }
        left_ = dashes_[index_] - rest;
    }

    void follow(const Vec2& a, const Vec2& b) {
        const double length = (b - a).norm();
        const Vec2 direction = (b - a) / length;
        double at = 0.0;
        if (on()) begin(a);
        // A zero-length dash is a dot: the pattern switches without moving.
        while (left_ <= length - at) {
            at += left_;
            const Vec2 cut = a + at * direction;
            if (on()) {
                current_.push_back(cut);
                end(direction);
            }
            index_ = (index_ + 1) % dashes_.size();
            left_ = dashes_[index_];
            if (on()) begin(cut);
        }
        left_ -= length - at;
        if (on()) current_.push_back(b);
        direction_ = direction;
    }

    bool on() const { return index_ % 2 == 0; }

    /// The pieces; those of a closed line that meet at its start are one.
    Lines finish(bool closed, bool began_on) {
        const bool ends_on = on() && !current_.empty();
        if (ends_on) end(direction_);
        if (closed && began_on && ends_on && pieces_.size() > 1) {
            Polyline& first = pieces_.front();
            Polyline joined = std::move(pieces_.back());
            pieces_.pop_back();
            joined.insert(joined.end(), first.begin() + 1, first.end());
            first = std::move(joined);
        }
        Lines lines{std::move(pieces_), {}};
        lines.closed.assign(lines.points.size(), false);
        return lines;
    }

  private:
    void begin(const Vec2& point) {
        if (current_.empty()) current_.push_back(point);
    }
    void end(const Vec2& direction) {
        Polyline clean;
        for (const Vec2& point : current_) {
            if (clean.empty() || (point - clean.back()).norm() > hair) clean.push_back(point);
        }
        if (clean.size() == 1) clean.emplace_back(clean.front() + 0.5 * hair * direction);
        pieces_.push_back(std::move(clean));
        current_.clear();
    }

    std::vector<double> dashes_;
    std::size_t index_ = 0;
    double left_ = 0.0;
    Polyline current_;
    std::vector<Polyline> pieces_;
    Vec2 direction_ = Vec2::UnitX();
};

double length_of(const Polyline& line, bool closed) {
    double length = closed ? (line.front() - line.back()).norm() : 0.0;
    for (std::size_t i = 1; i < line.size(); ++i) length += (line[i] - line[i - 1]).norm();
    return length;
}

/// A dot has the cap's form; square ones lie along the line.
Region dot(const Vec2& centre, const Vec2& direction, StrokeStyle style) {
    if (style.cap != LineCap::square) return stroke({centre}, false, style);
    style.cap = LineCap::butt;
    const Vec2 half = 0.5 * style.width * direction.normalized();
    return stroke({centre - half, centre + half}, false, style);
}

bool before(const Vec2& a, const Vec2& b) { return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y()); }
/// The points of a line that are among `turns` (sorted by `before`); not an open line's ends.
std::vector<std::size_t> turns_of(const Polyline& line, bool closed, const std::vector<Vec2>& turns) {
    std::vector<std::size_t> found;
    if (turns.empty()) return found;
    for (std::size_t i = closed ? 0 : 1; i < line.size() - (closed ? 0 : 1); ++i) {
        if (std::binary_search(turns.begin(), turns.end(), line[i], before)) found.push_back(i);
    }
    return found;
}

/// Strokes a line with round joins at some of its points and the style's joins at the others: cut there, with
/// a disc on every cut.
void stroke_round_at(Polyline line, bool closed, std::vector<std::size_t> turns, const StrokeStyle& style,
                     std::vector<Region>& parts) {
    StrokeStyle blunt = style, disc = style;
    blunt.cap = LineCap::butt;
    disc.cap = LineCap::round;
    if (closed) {
        const std::size_t first = turns.front();
        std::rotate(line.begin(), line.begin() + static_cast<std::ptrdiff_t>(first), line.end());
        line.push_back(line.front());
        for (std::size_t& turn : turns) turn -= first;
    } else if (style.cap == LineCap::square) {
        const double half = 0.5 * style.width;
        const Vec2 backward = (line[0] - line[1]).normalized();
        const Vec2 forward = (line[line.size() - 1] - line[line.size() - 2]).normalized();
        line.front() += half * backward;
        line.back() += half * forward;
    } else if (style.cap == LineCap::round) {
        parts.push_back(stroke({line.front()}, false, disc));
        parts.push_back(stroke({line.back()}, false, disc));
    }
    auto from = line.begin();
    for (const std::size_t turn : turns) {
        parts.push_back(stroke({line[turn]}, false, disc));
        const auto to = line.begin() + static_cast<std::ptrdiff_t>(turn);
        if (to == from) continue;
        parts.push_back(stroke({from, to + 1}, false, blunt));
        from = to;
    }
    parts.push_back(stroke({from, line.end()}, false, blunt));
}

Region mapped(const Region& region, const Mat2& map) {
    const bool mirrors = map.determinant() < 0.0;
    std::vector<Polyline> loops;
    const auto add = [&](const Polyline& loop) {
        Polyline image;
        for (const Vec2& point : loop) image.emplace_back(map * point);
        if (mirrors) std::reverse(image.begin(), image.end());
        loops.push_back(std::move(image));
    };
    for (const Polygon& polygon : region) {
        add(polygon.outer);
        for (const Polyline& hole : polygon.holes) add(hole);
    }
    return region_from_loops(loops, FillRule::nonzero);
}

/// Where the pen is round: coordinates in mm that differ from user units by a factor and perhaps a turn.
struct PenSpace {
    double scale = 1.0;         ///< from user units
    Vec2 axis = Vec2::UnitX();  ///< direction of the user's x axis
    Mat2 to_mm = Mat2::Identity();
    bool is_mm = true;
};

PenSpace pen_space(const Mat2& map) {
    const Stretches factors = stretches(map);
    PenSpace space;
    space.scale = factors.largest;
    if (factors.largest - factors.smallest <= 1e-9 * factors.largest) {
        space.axis = map.col(0) / factors.largest;
        return space;
    }
    space.to_mm = map / factors.largest;
    space.is_mm = false;
    return space;
}

}  // namespace

std::optional<Lines> dashed(const Polyline& line, bool closed, const std::vector<double>& dashes,
                            double offset) {
    const double period = std::accumulate(dashes.begin(), dashes.end(), 0.0);
    const double count = length_of(line, closed) / period * static_cast<double>(dashes.size());
    if (!(count <= most_dashes)) return std::nullopt;
    if (line.size() < 2) return Lines{{line}, {closed}};
    Dasher dasher(dashes, offset);
    const bool began_on = dasher.on();
    for (std::size_t i = 1; i < line.size(); ++i) dasher.follow(line[i - 1], line[i]);
    if (closed) dasher.follow(line.back(), line.front());
    Lines pieces = dasher.finish(closed, began_on);
    const bool never_off = pieces.points.size() == 1 && began_on &&
                           length_of(pieces.points[0], false) >= length_of(line, closed) - hair;
    if (never_off) return Lines{{line}, {closed}};
    return pieces;
}

Covered pen_cover(const Lines& lines, const Mat2& map, const SvgPen& pen) {
    const Stretches factors = stretches(map);
    if (!(factors.smallest > 1e-6 * factors.largest)) return {};
    const PenSpace space = pen_space(map);
    const Mat2 from_mm = space.is_mm ? Mat2(Mat2::Identity()) : Mat2(space.to_mm.inverse());
    StrokeStyle style = pen.style;
    style.width *= space.scale;
    std::vector<double> dashes = pen.dashes;
    for (double& dash : dashes) dash *= space.scale;

    std::vector<Vec2> turns;
    if (style.join != LineJoin::round) turns = lines.tight_turns;
    if (!space.is_mm) {
        for (Vec2& turn : turns) turn = from_mm * turn;
    }
    std::sort(turns.begin(), turns.end(), before);

    Covered covered;
    std::vector<Region> parts;
    for (std::size_t i = 0; i < lines.points.size(); ++i) {
        Polyline line = lines.points[i];
        if (!space.is_mm) {
            for (Vec2& point : line) point = from_mm * point;
        }
        if (line.size() == 1) {
            parts.push_back(dot(line.front(), space.axis, style));
            continue;
        }
        Lines pieces{{line}, {lines.closed[i]}};
        if (!dashes.empty()) {
            auto cut = dashed(line, lines.closed[i], dashes, pen.dash_offset * space.scale);
            // Gaps finer than anything that can be printed: the strip is as good as solid.
            covered.solid_instead = covered.solid_instead || !cut;
            if (cut) pieces = std::move(*cut);
        }
        for (std::size_t k = 0; k < pieces.points.size(); ++k) {
            const Polyline& piece = pieces.points[k];
            const bool is_dot = piece.size() == 2 && (piece[1] - piece[0]).norm() <= hair;
            const std::vector<std::size_t> round = turns_of(piece, pieces.closed[k], turns);
            if (is_dot) {
                parts.push_back(dot(piece[0], piece[1] - piece[0], style));
            } else if (round.empty()) {
                parts.push_back(stroke(piece, pieces.closed[k], style));
            } else {
                stroke_round_at(piece, pieces.closed[k], round, style, parts);
            }
        }
    }
    covered.region = parts.size() == 1 ? std::move(parts.front()) : unite(parts);
    if (!space.is_mm) covered.region = mapped(covered.region, space.to_mm);
    return covered;
}

}  // namespace ruche::svg
