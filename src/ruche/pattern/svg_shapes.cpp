#include "ruche/pattern/svg_shapes.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <optional>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "ruche/pattern/svg_page.hpp"
#include "ruche/pattern/svg_stroke.hpp"

namespace ruche::svg {

namespace {

constexpr std::size_t most_points = 1'000'000;
// Pairs of segments whose boxes overlap: of the lines themselves, and of what a pen covers.
struct Pairs {
    std::size_t lines = 0, pen = 0;
};
constexpr Pairs most_in_shape{200'000, 1'000'000};
constexpr Pairs most_in_drawing{1'000'000, 3'000'000};
constexpr std::size_t most_comparisons = 100'000'000;

struct SegmentBox {
    double left, right, low, high;
};

std::vector<SegmentBox> segment_boxes(const Lines& lines) {
    std::vector<SegmentBox> boxes;
    for (std::size_t i = 0; i < lines.points.size(); ++i) {
        const Polyline& line = lines.points[i];
        const std::size_t count = line.size();
        for (std::size_t k = lines.closed[i] ? 0 : 1; k < count; ++k) {
            const Vec2& a = line[(k + count - 1) % count];
            const Vec2& b = line[k];
            boxes.push_back({std::min(a.x(), b.x()), std::max(a.x(), b.x()), std::min(a.y(), b.y()),
                             std::max(a.y(), b.y())});
        }
    }
    std::sort(boxes.begin(), boxes.end(),
              [](const SegmentBox& a, const SegmentBox& b) { return a.left < b.left; });
    return boxes;
}

/// Bounds the work that a drawing may ask for. Boolean operations on n segments with k crossings cost about
/// (n + k) log n, and k may be n^2: pairs of segments whose boxes overlap are counted beforehand.
class Budget {
  public:
    Budget(const SvgFile& file, double tolerance) : file_(file), tolerance_(tolerance) {}

    void spend(const DrawnItem& item, const Lines& lines, double pen_radius) {
        for (const Polyline& line : lines.points) points_ += line.size();
        if (points_ > most_points) {
            throw InputError(file_.place(item.node),
                             fmt::format("the drawing has more than {} points at a tolerance of {} mm",
                                         most_points, tolerance_),
                             "Simplify the drawing, or allow a larger tolerance.");
        }
        const std::vector<SegmentBox> boxes = segment_boxes(lines);
        const std::size_t crossings = overlaps(boxes, 0.0, most_in_shape.lines);
        const std::size_t touches =
            pen_radius > 0.0 ? overlaps(boxes, 2.0 * pen_radius, most_in_shape.pen) : 0;
        total_.lines += crossings;
        total_.pen += touches;
        if (crossings > most_in_shape.lines || touches > most_in_shape.pen ||
            total_.lines > most_in_drawing.lines || total_.pen > most_in_drawing.pen) {
            throw InputError(file_.place(item.node), "the lines cross each other too often to be printed",
                             "Simplify this shape.");
        }
    }

  private:
    /// Pairs that come closer than `gap`; anything above `limit` when there are more.
    static std::size_t overlaps(const std::vector<SegmentBox>& boxes, double gap, std::size_t limit) {
        std::size_t count = 0, compared = 0;
        for (std::size_t i = 0; i < boxes.size(); ++i) {
            for (std::size_t j = i + 1; j < boxes.size() && boxes[j].left < boxes[i].right + gap; ++j) {
                if (boxes[j].low < boxes[i].high + gap && boxes[i].low < boxes[j].high + gap) ++count;
                // Long lines side by side do not cross, but so many of them are too many, too.
                if (count > limit || ++compared > most_comparisons) return limit + 1;
            }
        }
        return count;
    }

    const SvgFile& file_;
    double tolerance_;
    std::size_t points_ = 0;
    Pairs total_;
};

void check_coordinates(const SvgFile& file, const DrawnItem& item, const Vec2& point, double limit) {
    if (point.cwiseAbs().maxCoeff() <= limit) return;  // false for NaN, too
    throw InputError(file.place(item.node),
                     fmt::format("reaches to ({:.4g}, {:.4g}) mm; at most {:.0f} m are allowed", point.x(),
                                 point.y(), largest_page / 1000.0),
                     "Check the page's width, height and viewBox, and the transforms around this element.");
}

void check_before_flattening(const SvgFile& file, const DrawnItem& item) {
    const auto check = [&](const Vec2& point, double limit) {
        check_coordinates(file, item, item.to_mm * point, limit);
    };
    for (const Subpath& subpath : *item.outline) {
        check(subpath.start, largest_page);
        for (const Segment& segment : subpath.segments) {
            std::visit([&](const auto& part) { check(part.end, largest_page); }, segment);
            if (const auto* cubic = std::get_if<CubicTo>(&segment)) {
                check(cubic->control_1, 10.0 * largest_page);
                check(cubic->control_2, 10.0 * largest_page);
            }
        }
    }
}

bool returns_to_start(const Polyline& line) {
    return line.size() > 3 && (line.front() - line.back()).norm() <= 1e-6;
}

bool spans_area(const Polyline& line) {
    for (std::size_t i = 2; i < line.size(); ++i) {
        const Vec2 a = line[1] - line[0], b = line[i] - line[0];
        if (std::abs(a.x() * b.y() - a.y() * b.x()) > 1e-6) return true;
    }
    return false;
}

class ShapeMaker {
  public:
    ShapeMaker(const SvgFile& file, const PageMap& page, double tolerance, Warnings& warnings)
        : file_(file), page_(page), tolerance_(tolerance), warnings_(warnings), budget_(file, tolerance) {}

    /// All in chords first, so that a drawing with too much detail is refused before the costly part.
    std::vector<Shape> make(const std::vector<DrawnItem>& items) {
        std::vector<Lines> lines;
        lines.reserve(items.size());
        for (const DrawnItem& item : items) {
            lines.push_back(item.fill || item.stroke ? flattened(item) : Lines());
        }
        std::vector<Shape> shapes;
        for (std::size_t i = 0; i < items.size(); ++i) {
            if (std::optional<Shape> shape = make(items[i], lines[i])) shapes.push_back(std::move(*shape));
        }
        return shapes;
    }

  private:
    std::optional<Shape> make(const DrawnItem& item, const Lines& lines) {
        if (!item.fill && !item.stroke) {
            warn(item, "has neither fill nor stroke: not printed");
            return std::nullopt;
        }
        Shape shape;
        if (item.fill) fill(item, lines, shape);
        if (item.stroke) stroke_lines(item, lines, shape);
        if (shape.filled.empty() && shape.stroked.empty()) {
            warn(item, "covers nothing: not printed");
            return std::nullopt;
        }
        describe(item, lines, shape);
        return shape;
    }

    void warn(const DrawnItem& item, const std::string& text) { warnings_.add(file_.place(item.node), text); }

    /// The linear map from the units of the pen to mm, and the pen's width after it.
    Mat2 pen_map(const DrawnItem& item) const {
        if (!item.style.non_scaling_stroke) return item.to_mm.linear;
        return page_.mm_per_px * Mat2::Identity();
    }

    Lines flattened(const DrawnItem& item) {
        check_before_flattening(file_, item);
        Flattening how{tolerance_, 0.0};
        if (item.stroke) {
            how.pen_radius = 0.5 * item.style.stroke_width * stretches(pen_map(item)).largest;
            check_coordinates(file_, item, Vec2::Constant(how.pen_radius), largest_page);
        }
        Lines lines;
        for (const Subpath& subpath : *item.outline) {
            FlatLine flat = flatten(subpath, item.to_mm, how);
            lines.points.push_back(std::move(flat.points));
            lines.tight_turns.insert(lines.tight_turns.end(), flat.tight_turns.begin(),
                                     flat.tight_turns.end());
            lines.closed.push_back(subpath.closed);
            for (const Vec2& point : lines.points.back()) check_coordinates(file_, item, point, largest_page);
        }
        budget_.spend(item, lines, how.pen_radius);
        return lines;
    }

    void fill(const DrawnItem& item, const Lines& lines, Shape& shape) {
        // Nobody who draws an open line with a stroke and says nothing of a fill wants SVG's default black.
        const bool by_default = item.stroke && !item.style.fill_given;
        bool left_open = false;
        std::vector<Polyline> loops;
        for (std::size_t i = 0; i < lines.points.size(); ++i) {
            const Polyline& line = lines.points[i];
            if (line.size() < 3) continue;
            if (by_default && !lines.closed[i] && !returns_to_start(line)) {
                left_open = left_open || spans_area(line);
            } else {
                loops.push_back(line);
            }
        }
        if (left_open) {
            warn(item, "is open and only SVG's default would fill it black: taken as a line without fill");
        }
        if (!loops.empty()) shape.filled = region_from_loops(loops, item.style.fill_rule);
        if (!shape.filled.empty()) shape.fill_colour = hex_colour(*item.fill);
    }

    void stroke_lines(const DrawnItem& item, const Lines& lines, Shape& shape) {
        const Mat2 map = pen_map(item);
        SvgPen pen;
        pen.style = {item.style.stroke_width, item.style.cap, item.style.join, item.style.miter_limit,
                     tolerance_};
        pen.dashes = item.style.dashes;
        pen.dash_offset = item.style.dash_offset;
        const double path_length = item.node.attribute("pathLength").as_double(0.0);
        if (!pen.dashes.empty() && path_length > 0.0) {
            // The author counts the whole path as so long.
            const double factor = user_length(lines, map) / path_length;
            for (double& dash : pen.dashes) dash *= factor;
            pen.dash_offset *= factor;
        }
        Covered covered = pen_cover(lines, map, pen);
        shape.stroked = std::move(covered.region);
        if (shape.stroked.empty()) return;
        if (covered.solid_instead) {
            warn(item, fmt::format("has more than {} dashes and gaps: printed as a solid line", most_dashes));
        }
        shape.stroke_colour = hex_colour(*item.stroke);
        shape.stroke_width = item.style.stroke_width * std::sqrt(std::abs(map.determinant()));
    }

    static double user_length(const Lines& lines, const Mat2& map) {
        const double determinant = map.determinant();
        if (determinant == 0.0) return 0.0;
        const Mat2 back = map.inverse();
        double length = 0.0;
        for (std::size_t i = 0; i < lines.points.size(); ++i) {
            const Polyline& line = lines.points[i];
            for (std::size_t k = lines.closed[i] ? 0 : 1; k < line.size(); ++k) {
                length += (back * (line[k] - line[(k + line.size() - 1) % line.size()])).norm();
            }
        }
        return length;
    }

    void describe(const DrawnItem& item, const Lines& lines, Shape& shape) {
        shape.id = unique_id(item);
        shape.label = item.label;
        shape.layer = item.layer;
        shape.groups = item.groups;
        shape.classes = class_names(item.node);
        shape.lines = lines.points;
        shape.closed = lines.closed;
        shape.line = file_.line(item.node);
    }

    std::string unique_id(const DrawnItem& item) {
        ++order_;
        const std::string wanted =
            item.id.empty() ? fmt::format("{}-{}", local_name(item.node), order_) : item.id;
        std::string id = wanted;
        int& next = next_suffix_[wanted];
        while (!ids_.insert(id).second) id = fmt::format("{}-{}", wanted, (next = std::max(next, 1) + 1));
        return id;
    }

    const SvgFile& file_;
    const PageMap& page_;
    double tolerance_;
    Warnings& warnings_;
    Budget budget_;
    std::size_t order_ = 0;
    std::unordered_set<std::string> ids_;
    std::unordered_map<std::string, int> next_suffix_;
};

}  // namespace

void Extent::include(const Region& region) {
    for (const Polygon& polygon : region) {
        for (const Vec2& point : polygon.outer) {
            low = low.cwiseMin(point);
            high = high.cwiseMax(point);
        }
    }
}

std::vector<Shape> make_shapes(const SvgFile& file, const std::vector<DrawnItem>& items, const PageMap& page,
                               double tolerance_mm, Warnings& warnings) {
    return ShapeMaker(file, page, tolerance_mm, warnings).make(items);
}

}  // namespace ruche::svg
