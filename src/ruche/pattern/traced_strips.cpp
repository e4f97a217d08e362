#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <map>
#include <optional>

#include "ruche/core/error.hpp"
#include "ruche/pattern/direction_grid.hpp"
#include "ruche/pattern/generators.hpp"
#include "ruche/pattern/tiling.hpp"

namespace ruche {
namespace {

constexpr std::string_view direction_fields[] = {"parallel", "radial", "circular", "hyperbolic", "file"};
constexpr double trace_step = 0.25;     // mm
constexpr double closest_share = 0.75;  // of the spacing: where a line ends
constexpr double smallest_room = 0.1;   // mm, between strips
constexpr std::size_t most_traced_points = 400000;

/// Distance of centre lines that leaves room between strips, however close the tracer lets lines come.
double smallest_spacing(double width) { return (width + smallest_room) / closest_share; }

/// Directions and distances over the layout.
class StripField {
  public:
    explicit StripField(const TracedStripsOptions& options) : options_(options) {
        if (options.field != DirectionField::file) return;
        grid_.emplace(options.file);
        grid_->require_disc(options.outer);
        grid_->require_spacing(smallest_spacing(options.width), options.width);
    }

    bool holds(const Vec2& p) const {
        const double r = p.norm();
        const double border = options_.rim + 0.5 * options_.width;
        return r <= options_.outer - border && (options_.inner == 0.0 || r >= options_.inner + border);
    }

    double spacing(const Vec2& p) const {
        if (grid_) return grid_->spacing(p);
        const double share = (p.norm() - options_.inner) / (options_.outer - options_.inner);
        return std::lerp(options_.spacing, options_.outer_spacing, std::clamp(share, 0.0, 1.0));
    }

    double largest_spacing() const {
        return grid_ ? grid_->largest_spacing() : std::max(options_.spacing, options_.outer_spacing);
    }

    /// Unit vector of the line through p, the one of the two that goes on from `before`.
    Vec2 direction(const Vec2& p, const Vec2& before) const {
        const double angle = angle_at(p) + options_.turn * M_PI / 180.0;
        const Vec2 along(std::cos(angle), std::sin(angle));
        return along.dot(before) < 0.0 ? Vec2(-along) : along;
    }

    /// A step of the fourth-order Runge-Kutta method; `along` is turned to the new direction.
    Vec2 step(const Vec2& p, Vec2& along) const {
        const Vec2 k1 = direction(p, along);
        const Vec2 k2 = direction(p + 0.5 * trace_step * k1, k1);
        const Vec2 k3 = direction(p + 0.5 * trace_step * k2, k2);
        const Vec2 k4 = direction(p + trace_step * k3, k3);
        along = k4;
        return p + trace_step / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
    }

  private:
    double angle_at(const Vec2& p) const {
        const double polar = std::atan2(p.y(), p.x());
        switch (options_.field) {
            case DirectionField::parallel:
                return 0.0;
            case DirectionField::radial:
                return polar;
            case DirectionField::circular:
                return polar + 0.5 * M_PI;
            case DirectionField::hyperbolic:
                return -polar;  // along the gradient of x^2 - y^2
            case DirectionField::file:
                return grid_->angle(p);
        }
        return 0.0;
    }

    const TracedStripsOptions& options_;
    std::optional<DirectionGrid> grid_;
};

/// Points in the order in which they came, by cells as large as the largest distance asked for.
class PointCells {
  public:
    explicit PointCells(double size) : size_(size) {}

    void add(const Vec2& p) { cells_[cell(p)].push_back({p, count_++}); }
    std::size_t count() const { return count_; }

    /// Whether one of the first `first` points is nearer to p.
    bool any_within(const Vec2& p, double distance, std::size_t first) const {
        const auto [cx, cy] = cell(p);
        for (int i = cx - 1; i <= cx + 1; ++i) {
            for (int j = cy - 1; j <= cy + 1; ++j) {
                const auto found = cells_.find({i, j});
                if (found == cells_.end()) continue;
                for (const auto& [q, number] : found->second)
                    if (number < first && (p - q).squaredNorm() < distance * distance) return true;
            }
        }
        return false;
    }

  private:
    std::pair<int, int> cell(const Vec2& p) const {
        return {static_cast<int>(std::floor(p.x() / size_)), static_cast<int>(std::floor(p.y() / size_))};
    }

    double size_;
    std::map<std::pair<int, int>, std::vector<std::pair<Vec2, std::size_t>>> cells_;
    std::size_t count_ = 0;
};

class StripTracer {
  public:
    explicit StripTracer(const TracedStripsOptions& options)
        : field_(options), reach_(field_.largest_spacing()), points_(reach_) {}

    std::vector<Polyline> lines(const Vec2& first_seed) {
        std::deque<Seed> seeds = {{first_seed, field_.spacing(first_seed)}};
        std::vector<Polyline> traced;
        while (!seeds.empty()) {
            const auto [seed, beside] = seeds.front();
            seeds.pop_front();
            // A hair less, so that a seed exactly beside a line is not too close to it; and no more than
            // where it was put, so that lines go on to where the spacing is larger.
            if (!field_.holds(seed) || too_close(seed, 0.98 * std::min(beside, field_.spacing(seed))))
                continue;
            Polyline line = trace(seed);
            for (const Vec2& p : line) points_.add(p);
            if (points_.count() > most_traced_points)
                throw InputError({.key = "spacing_mm"}, "gives more strips than anybody prints",
                                 "Give a larger spacing_mm or a smaller outer_mm.");
            add_seeds(line, seeds);
            traced.push_back(std::move(line));
        }
        return traced;
    }

  private:
    /// Where a line may begin, and how far beside another one that is.
    struct Seed {
        Vec2 at;
        double beside;
    };

    Polyline trace(const Vec2& seed) const {
        Polyline line = {seed};
        const Vec2 along = field_.direction(seed, Vec2(1.0, 0.3));
        follow(line, along);
        std::ranges::reverse(line);
        follow(line, -along);
        return line;
    }

    /// Goes on from the line's last point until there is no room.
    void follow(Polyline& line, Vec2 along) const {
        PointCells own(reach_);
        for (const Vec2& p : line) own.add(p);
        while (line.size() < most_traced_points) {
            const Vec2 next = field_.step(line.back(), along);
            const double room = closest_share * field_.spacing(next);
            // Its neighbours along the line are no reason to end.
            const auto neighbours = static_cast<std::size_t>(2.0 * room / trace_step) + 1;
            const std::size_t others = line.size() - std::min(neighbours, line.size());
            if (!field_.holds(next) || too_close(next, room) || own.any_within(next, room, others)) return;
            line.push_back(next);
            own.add(next);
        }
    }

    bool too_close(const Vec2& p, double room) const { return points_.any_within(p, room, points_.count()); }

    void add_seeds(const Polyline& line, std::deque<Seed>& seeds) const {
        for (std::size_t i = 1; i < line.size(); ++i) {
            const Vec2 along = (line[i] - line[i - 1]).normalized();
            const double beside = field_.spacing(line[i]);
            const Vec2 across = beside * Vec2(-along.y(), along.x());
            seeds.push_back({line[i] + across, beside});
            seeds.push_back({line[i] - across, beside});
        }
    }

    StripField field_;
    double reach_;       // the largest distance asked for
    PointCells points_;  // of all lines so far
};

/// Pieces of a line: every second line begins with half a strip. Points are `trace_step` apart.
std::vector<Polyline> cut_into_strips(const Polyline& line, const TracedStripsOptions& options,
                                      bool shifted) {
    const auto points_in = [](double length) {
        return static_cast<std::size_t>(std::lround(length / trace_step));
    };
    if (options.length == 0.0) return {line};
    const std::size_t whole = points_in(options.length);
    const std::size_t gap = std::max<std::size_t>(1, points_in(options.gap));
    std::vector<Polyline> pieces;
    std::size_t begin = 0;
    std::size_t end = shifted ? whole / 2 : whole;
    while (begin + 1 < line.size()) {
        end = std::min(end, line.size() - 1);
        pieces.emplace_back(line.begin() + static_cast<std::ptrdiff_t>(begin),
                            line.begin() + static_cast<std::ptrdiff_t>(end) + 1);
        begin = end + gap;
        end = begin + whole;
    }
    return pieces;
}

/// A file goes with field = "file" and brings its own spacing.
void check_field_file(const TracedStripsOptions& o) {
    const bool from_file = o.field == DirectionField::file;
    if (from_file && o.file.empty())
        throw InputError({.key = "file"}, "no file of the field is given",
                         "A node \"x_mm, y_mm, angle_deg, spacing_mm\" per line, on a complete grid.");
    if (!from_file && !o.file.empty())
        throw InputError({.key = "file"}, "is given, but the field is none from a file",
                         "Give field = \"file\".");
    const TracedStripsOptions initial;
    if (from_file && (o.spacing != initial.spacing || o.outer_spacing != initial.outer_spacing))
        throw InputError({.key = o.spacing != initial.spacing ? "spacing_mm" : "outer_spacing_mm"},
                         "means nothing with a field from a file, which has its own spacing_mm");
}

void check_traced(const TracedStripsOptions& o) {
    if (o.inner >= o.outer)
        throw InputError({.key = "inner_mm"},
                         fmt::format("{} is not smaller than outer_mm = {}", o.inner, o.outer));
    check_field_file(o);
    if (std::min(o.spacing, o.outer_spacing) < smallest_spacing(o.width) && o.file.empty())
        throw InputError(
            {.key = "spacing_mm"},
            fmt::format("lines {} mm apart, which may come as close as {:g} of that, leave no room "
                        "between strips of {} mm width",
                        std::min(o.spacing, o.outer_spacing), closest_share, o.width),
            fmt::format("Give a spacing of at least {:.3g} mm.", smallest_spacing(o.width)));
    const bool has_centre = o.field != DirectionField::parallel && o.field != DirectionField::file;
    if (has_centre && o.inner < o.width)
        throw InputError({.key = "inner_mm"},
                         fmt::format("{} mm: this field has no direction in its middle", o.inner),
                         "Give an inner_mm of at least width_mm: the fabric gets a hole.");
}

}  // namespace

template <>
std::span<const Field<TracedStripsOptions>> fields<TracedStripsOptions>() {
    using S = TracedStripsOptions;
    static const Field<S> table[] = {
        {"field", choice<&S::field>(direction_fields), "", 0, 0,
         "Directions: parallel to x, radial, circular, along the gradient of x^2 - y^2, or from a file."},
        {"file", &S::file, "", -infinity, infinity,
         "Of field = \"file\": directions and spacing on a grid, \"x_mm, y_mm, angle_deg, spacing_mm\" per "
         "line, in any order; every x needs every y."},
        {"turn_deg", &S::turn, "deg", -180, 180, "Angle from the field's direction to the strips'."},
        {"inner_mm", &S::inner, "mm", 0, 1e4, "Radius of the hole in the fabric; 0 = none."},
        {"outer_mm", &S::outer, "mm", 1.0, 1e4, "Radius of the fabric."},
        {"rim_mm", &S::rim, "mm", 0, 1e3, "Bare fabric between the print and the borders."},
        {"spacing_mm", &S::spacing, "mm", 0.2, 1e3,
         "Distance between neighbouring lines at the inner radius."},
        {"outer_spacing_mm", &S::outer_spacing, "mm", 0.2, 1e3,
         "The same at the outer radius; linear between."},
        {"width_mm", &S::width, "mm", 0.1, 1e3, "Width of each strip."},
        {"length_mm", &S::length, "mm", 0, 1e4, "Length of each strip; 0 = lines are not cut."},
        {"gap_mm", &S::gap, "mm", 0.1, 1e3, "Fabric between the ends of strips of one line."},
        {"back_inside_mm", &S::back_inside, "mm", 0, 1e4,
         "Strips whose middle is nearer to the centre are printed on the other side."},
    };
    return table;
}

GeneratedPattern generate_traced(const TracedStripsOptions& options) {
    check_traced(options);
    GeneratedPattern result;
    // Away from axes of symmetry nothing is decided by rounding.
    const double radius = 0.5 * (options.inner + options.outer);
    const double angle = 0.1;
    const Vec2 seed = options.field == DirectionField::parallel && options.inner == 0.0
                          ? Vec2(0.0, 0.0)
                          : Vec2(radius * std::cos(angle), radius * std::sin(angle));
    std::size_t number = 0;
    for (const Polyline& line : StripTracer(options).lines(seed)) {
        ++number;
        std::size_t piece_number = 0;
        for (Polyline& piece : cut_into_strips(line, options, number % 2 == 0)) {
            const double length = trace_step * static_cast<double>(piece.size() - 1);
            if (length < 2.0 * options.width) continue;  // what an end leaves is no strip
            const bool back = piece[piece.size() / 2].norm() < options.back_inside;
            result.strips.push_back({.id = fmt::format("line-{}-{}", number, ++piece_number),
                                     .lines = {{std::move(piece), false}},
                                     .width = options.width,
                                     .side = back ? Side::back : Side::front});
        }
    }
    result.fabric.push_back(circle_polygon(options.outer));
    if (options.inner > 0.0) result.fabric.push_back(circle_polygon(options.inner));
    return result;
}

}  // namespace ruche
