#include "ruche/pattern/svg_path.hpp"

#include <algorithm>
#include <vector>

#include "ruche/pattern/svg_scanner.hpp"

namespace ruche::svg {

namespace {

std::string error_at(const Scanner& scanner, std::string_view wanted) {
    std::string found = "at the end";
    if (!scanner.at_end()) {
        found = "at '" + std::string(scanner.rest().substr(0, 12)) + "' (character " +
                std::to_string(scanner.position() + 1) + ")";
    }
    return std::string(wanted) + " expected " + found;
}

class PathReader {
  public:
    explicit PathReader(std::string_view data) : scanner_(data) {}

    PathReading run() {
        scanner_.skip_space();
        while (!scanner_.at_end() && !error_) command();
        finish_subpath();
        return {std::move(outline_), std::move(error_)};
    }

  private:
    void command() {
        const char letter = scanner_.peek();
        const bool relative = letter >= 'a' && letter <= 'z';
        const char kind = relative ? static_cast<char>(letter - 'a' + 'A') : letter;
        const bool known = std::string_view("MZLHVCSQTA").find(kind) != std::string_view::npos;
        if (!known || (!started_ && kind != 'M')) {
            error_ = error_at(scanner_, started_ ? "a command (one of MZLHVCSQTA)" : "M");
            return;
        }
        scanner_.accept(letter);
        scanner_.skip_space();
        if (kind == 'Z') {
            close();
            return;
        }
        char repeated = kind;
        do {
            origin_ = relative ? point_ : Vec2::Zero();
            if (!draw(repeated)) return;
            if (repeated == 'M') repeated = 'L';  // further points of a moveto are linetos
            scanner_.skip_separator();
        } while (number_follows());
    }

    bool number_follows() const {
        const char c = scanner_.peek();
        return (c >= '0' && c <= '9') || c == '.' || c == '-' || c == '+';
    }

    /// Draws one command with its arguments; false at an error, and then nothing of it is drawn.
    bool draw(char kind) {
        const Vec2 before = point_;
        switch (kind) {
            case 'M':
                return move();
            case 'L':
                if (const auto end = point()) return add(LineTo{*end}, *end);
                return false;
            case 'H':
                if (const auto x = coordinate()) return line_to({origin_.x() + *x, before.y()});
                return false;
            case 'V':
                if (const auto y = coordinate()) return line_to({before.x(), origin_.y() + *y});
                return false;
            case 'C':
            case 'S':
                return cubic(kind == 'S');
            case 'Q':
            case 'T':
                return quadratic(kind == 'T');
            default:
                return arc();
        }
    }

    bool move() {
        const auto start = point();
        if (!start) return false;
        finish_subpath();
        started_ = true;
        open_ = true;
        current_ = Subpath{*start, {}, false};
        point_ = *start;
        forget_controls();
        return true;
    }

    bool line_to(const Vec2& end) { return add(LineTo{end}, end); }

    bool cubic(bool smooth) {
        const Vec2 before = point_;
        const Vec2 reflected = cubic_control_ ? Vec2(2.0 * before - *cubic_control_) : before;
        const auto control_1 = smooth ? std::optional<Vec2>(reflected) : point();
        if (!control_1) return false;
        const auto control_2 = point();
        if (!control_2) return false;
        const auto end = point();
        if (!end) return false;
        add(CubicTo{*control_1, *control_2, *end}, *end);
        cubic_control_ = *control_2;
        return true;
    }

    bool quadratic(bool smooth) {
        const Vec2 before = point_;
        const Vec2 reflected = quadratic_control_ ? Vec2(2.0 * before - *quadratic_control_) : before;
        const auto control = smooth ? std::optional<Vec2>(reflected) : point();
        if (!control) return false;
        const auto end = point();
        if (!end) return false;
        add(CubicTo{(before + 2.0 * *control) / 3.0, (*end + 2.0 * *control) / 3.0, *end}, *end);
        quadratic_control_ = *control;
        return true;
    }

    bool arc() {
        EndpointArc arc;
        arc.from = point_;
        const auto rx = coordinate();
        if (!rx) return false;
        const auto ry = coordinate();
        if (!ry) return false;
        const auto rotation = coordinate();
        if (!rotation) return false;
        const auto large = flag();
        if (!large) return false;
        const auto positive = flag();
        if (!positive) return false;
        const auto end = point();
        if (!end) return false;
        arc.radii = {*rx, *ry};
        arc.rotation_deg = *rotation;
        arc.large = *large;
        arc.positive = *positive;
        arc.to = *end;
        return add(arc_segment(arc), *end);
    }

    void close() {
        // A second Z in a row draws nothing; after Z a new subpath starts where the closed one did.
        if (open_) {
            current_.closed = true;
            outline_.push_back(current_);
            open_ = false;
        }
        point_ = current_.start;
        forget_controls();
        scanner_.skip_space();
    }

    bool add(const Segment& segment, const Vec2& end) {
        if (!open_) {
            current_ = Subpath{current_.start, {}, false};
            open_ = true;
        }
        current_.segments.push_back(segment);
        point_ = end;
        forget_controls();
        return true;
    }

    void finish_subpath() {
        // A moveto alone draws nothing.
        if (open_ && !current_.segments.empty()) outline_.push_back(current_);
        open_ = false;
    }

    void forget_controls() {
        cubic_control_.reset();
        quadratic_control_.reset();
    }

    std::optional<double> coordinate() {
        const std::optional<double> value = scanner_.number();
        if (!value) error_ = error_at(scanner_, "a number");
        if (value) scanner_.skip_separator();
        return value;
    }
    std::optional<bool> flag() {
        const std::optional<bool> value = scanner_.flag();
        if (!value) error_ = error_at(scanner_, "an arc flag (0 or 1)");
        if (value) scanner_.skip_separator();
        return value;
    }
    std::optional<Vec2> point() {
        const auto x = coordinate();
        if (!x) return std::nullopt;
        const auto y = coordinate();
        if (!y) return std::nullopt;
        return Vec2(origin_ + Vec2(*x, *y));
    }

    Scanner scanner_;
    Outline outline_;
    std::optional<std::string> error_;
    Subpath current_;
    bool started_ = false, open_ = false;
    Vec2 point_ = Vec2::Zero(), origin_ = Vec2::Zero();
    std::optional<Vec2> cubic_control_, quadratic_control_;
};

}  // namespace

PathReading parse_path(std::string_view data) {
    if (trimmed(data) == "none") return {};
    return PathReader(data).run();
}

PathReading parse_points(std::string_view data, bool closed) {
    PathReading reading;
    std::vector<Vec2> points;
    Scanner scanner(trimmed(data));
    while (!scanner.at_end() && !reading.error) {
        const std::optional<double> x = scanner.number();
        scanner.skip_separator();
        const std::optional<double> y = x ? scanner.number() : std::nullopt;
        if (y) {
            points.emplace_back(*x, *y);
            scanner.skip_separator();
        } else {
            reading.error = error_at(scanner, "a number");
        }
    }
    reading.outline = polygon_outline(points, closed);
    return reading;
}

}  // namespace ruche::svg
