#include "ruche/pattern/svg_outline.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ruche::svg {

namespace {

constexpr double pi = std::numbers::pi;
constexpr double same_point = 1e-7;
constexpr int deepest_split = 14;
constexpr int most_arc_chords = 20000;
constexpr double slender = 3.0;

/// The angle that a chord of a circle of this radius may span.
double chord_angle(double tolerance, double radius) {
    if (radius <= tolerance) return pi / 2.0;
    return std::min(pi / 2.0, 2.0 * std::acos(1.0 - tolerance / radius));
}

double turn(const Vec2& a, const Vec2& b) { return std::abs(std::atan2(cross(a, b), a.dot(b))); }

double distance_to_chord(const Vec2& point, const Vec2& a, const Vec2& b) {
    const Vec2 chord = b - a;
    const double squared = chord.squaredNorm();
    const double along = squared > 0.0 ? std::clamp((point - a).dot(chord) / squared, 0.0, 1.0) : 0.0;
    return (point - a - along * chord).norm();
}

struct Cubic {
    Vec2 a, b, c, d;

    bool flat(double tolerance) const {
        // A curve lies in the hull of its control points, a segment's surroundings are convex.
        return distance_to_chord(b, a, d) <= tolerance && distance_to_chord(c, a, d) <= tolerance;
    }
    bool within(double distance) const {
        return (b - a).norm() <= distance && (c - a).norm() <= distance && (d - a).norm() <= distance;
    }
    double turning() const {
        const Vec2 legs[] = {b - a, c - b, d - c};
        double total = 0.0;
        Vec2 last = Vec2::Zero();
        for (const Vec2& leg : legs) {
            if (leg.norm() <= same_point) continue;
            if (!last.isZero(0.0)) total += turn(last, leg);
            last = leg;
        }
        return total;
    }
};

void append(Polyline& line, const Vec2& point) {
    if (line.empty() || (point - line.back()).norm() > same_point) line.push_back(point);
}

class Flattener {
  public:
    Flattener(const Affine& map, const Flattening& how)
        : map_(map), how_(how), pen_angle_(chord_angle(how.tolerance, how.pen_radius)) {}

    FlatLine run(const Subpath& subpath) {
        const Vec2 start = map_ * subpath.start;
        append(line_.points, start);
        last_ = start;
        for (const Segment& segment : subpath.segments) {
            std::visit([this](const auto& part) { add(part); }, segment);
        }
        Polyline& points = line_.points;
        if (subpath.closed) {
            while (points.size() > 1 && (points.back() - points.front()).norm() <= same_point)
                points.pop_back();
        }
        return std::move(line_);
    }

  private:
    void add(const LineTo& part) { to(map_ * part.end); }
    void add(const CubicTo& part) {
        split({last_, map_ * part.control_1, map_ * part.control_2, map_ * part.end}, 0);
        last_ = map_ * part.end;
    }
    void add(const ArcTo& part) {
        const Vec2 centre = map_ * part.centre;
        Mat2 axes;
        axes << map_.linear * part.u, map_.linear * part.v;
        const Stretches radii = stretches(axes);
        if (radii.largest > slender * radii.smallest) {
            slender_arc(part, centre, axes);
            return;
        }
        const double step = chord_angle(how_.tolerance, radii.largest + how_.pen_radius);
        const int count = pieces(part.sweep, step);
        for (int i = 1; i < count; ++i) {
            const double angle = part.start + part.sweep * i / count;
            append(line_.points, centre + axes * Vec2(std::cos(angle), std::sin(angle)));
        }
        to(map_ * part.end);
    }
    /// An ellipse that is nearly flat turns sharply at its tips: as curves, which are split by turning. A
    /// cubic misses pi/8 of a circle by less than 1e-7 of the radius.
    void slender_arc(const ArcTo& part, const Vec2& centre, const Mat2& axes) {
        const int count = pieces(part.sweep, pi / 8.0);
        const double step = part.sweep / count, reach = 4.0 / 3.0 * std::tan(step / 4.0);
        for (int i = 0; i < count; ++i) {
            const double from = part.start + step * i, to = from + step;
            const Vec2 a(std::cos(from), std::sin(from)), d(std::cos(to), std::sin(to));
            const Vec2 b = a + reach * Vec2(-a.y(), a.x()), c = d - reach * Vec2(-d.y(), d.x());
            const Vec2 end = i + 1 == count ? Vec2(map_ * part.end) : Vec2(centre + axes * d);
            split({last_, centre + axes * b, centre + axes * c, end}, 0);
            last_ = end;
        }
    }
    void split(const Cubic& cubic, int depth) {
        // The pen's edge turns about the curve's points: it needs chords that turn by little.
        const bool fine = cubic.flat(how_.tolerance) && cubic.turning() <= pen_angle_;
        const bool tight = !fine && (depth == deepest_split || cubic.within(how_.tolerance));
        if (tight) line_.tight_turns.push_back(line_.points.back());
        if (fine || tight) append(line_.points, cubic.d);
        if (tight) line_.tight_turns.push_back(line_.points.back());
        if (fine || tight) return;
        const Vec2 ab = (cubic.a + cubic.b) / 2.0, bc = (cubic.b + cubic.c) / 2.0,
                   cd = (cubic.c + cubic.d) / 2.0;
        const Vec2 abc = (ab + bc) / 2.0, bcd = (bc + cd) / 2.0;
        const Vec2 middle = (abc + bcd) / 2.0;
        split({cubic.a, ab, abc, middle}, depth + 1);
        split({middle, bcd, cd, cubic.d}, depth + 1);
    }
    void to(const Vec2& point) {
        append(line_.points, point);
        last_ = point;
    }
    static int pieces(double sweep, double step) {
        const double count = std::ceil(std::abs(sweep) / step - 1e-9);
        return std::max(1, static_cast<int>(std::min<double>(count, most_arc_chords)));
    }

    Affine map_;
    Flattening how_;
    double pen_angle_;
    FlatLine line_;
    Vec2 last_ = Vec2::Zero();
};

}  // namespace

Segment arc_segment(const EndpointArc& arc) {
    Vec2 radii = arc.radii.cwiseAbs();
    const double chord = (arc.to - arc.from).norm();
    // A radius so large that the arc is straight to rounding would only lose digits at its far centre.
    const bool straight = !arc.large && radii.minCoeff() > 1e8 * chord;
    if (radii.minCoeff() <= 0.0 || chord == 0.0 || straight) return LineTo{arc.to};
    const double angle = arc.rotation_deg * pi / 180.0;
    Mat2 axes;
    axes << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle);
    // Half the chord on the unit circle's scale.
    const Vec2 half = (axes.transpose() * (arc.from - arc.to) / 2.0).cwiseQuotient(radii);
    const double squared = half.squaredNorm();
    if (squared > 1.0) radii *= std::sqrt(squared);
    const Vec2 unit_half = squared > 1.0 ? Vec2(half / std::sqrt(squared)) : half;
    const double height = std::sqrt(std::max(0.0, 1.0 / unit_half.squaredNorm() - 1.0));
    const double side = arc.large == arc.positive ? -1.0 : 1.0;
    const Vec2 centre = side * height * Vec2(unit_half.y(), -unit_half.x());
    const Vec2 from = unit_half - centre, to = -unit_half - centre;
    double sweep = std::atan2(cross(from, to), from.dot(to));
    if (arc.positive && sweep < 0.0) sweep += 2.0 * pi;
    if (!arc.positive && sweep > 0.0) sweep -= 2.0 * pi;
    const ArcTo result{(arc.from + arc.to) / 2.0 + axes * centre.cwiseProduct(radii),
                       axes.col(0) * radii.x(),
                       axes.col(1) * radii.y(),
                       std::atan2(from.y(), from.x()),
                       sweep,
                       arc.to};
    if (!result.centre.allFinite() || !std::isfinite(sweep)) return LineTo{arc.to};
    return result;
}

Outline ellipse_outline(const Vec2& centre, const Vec2& radii) {
    const Vec2 u(radii.x(), 0.0), v(0.0, radii.y());
    Subpath subpath{centre + u, {}, true};
    const Vec2 ends[] = {centre + v, centre - u, centre - v, centre + u};
    for (int quarter = 0; quarter < 4; ++quarter) {
        subpath.segments.emplace_back(ArcTo{centre, u, v, quarter * pi / 2.0, pi / 2.0, ends[quarter]});
    }
    return {subpath};
}

Outline rectangle_outline(const Box& box, const Vec2& radii) {
    const Vec2 r = radii.cwiseMin(box.size / 2.0);
    const Vec2 low = box.corner, high = box.corner + box.size;
    if (r.minCoeff() <= 0.0) {
        return polygon_outline({low, {high.x(), low.y()}, high, {low.x(), high.y()}}, true);
    }
    const Vec2 u(r.x(), 0.0), v(0.0, r.y());
    const Vec2 inner_low = low + r, inner_high = high - r;
    Subpath subpath{{inner_low.x(), low.y()}, {}, true};
    const auto side_and_corner = [&](const Vec2& side_end, const Vec2& centre, double start,
                                     const Vec2& corner_end) {
        subpath.segments.emplace_back(LineTo{side_end});
        subpath.segments.emplace_back(ArcTo{centre, u, v, start, pi / 2.0, corner_end});
    };
    side_and_corner({inner_high.x(), low.y()}, {inner_high.x(), inner_low.y()}, -pi / 2.0,
                    {high.x(), inner_low.y()});
    side_and_corner({high.x(), inner_high.y()}, inner_high, 0.0, {inner_high.x(), high.y()});
    side_and_corner({inner_low.x(), high.y()}, {inner_low.x(), inner_high.y()}, pi / 2.0,
                    {low.x(), inner_high.y()});
    side_and_corner({low.x(), inner_low.y()}, inner_low, pi, {inner_low.x(), low.y()});
    return {subpath};
}

Outline polygon_outline(const std::vector<Vec2>& points, bool closed) {
    if (points.empty()) return {};
    Subpath subpath{points.front(), {}, closed};
    for (std::size_t i = 1; i < points.size(); ++i) subpath.segments.emplace_back(LineTo{points[i]});
    return {subpath};
}

FlatLine flatten(const Subpath& subpath, const Affine& map, const Flattening& how) {
    return Flattener(map, how).run(subpath);
}

}  // namespace ruche::svg
