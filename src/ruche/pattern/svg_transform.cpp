#include "ruche/pattern/svg_transform.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "ruche/pattern/svg_scanner.hpp"

namespace ruche::svg {

namespace {

constexpr double radians_per_degree = std::numbers::pi / 180.0;

Affine rotation(double degrees) {
    // Quarter turns exactly: they are what people draw, and the printed area shall be exact.
    const double quarters = degrees / 90.0;
    double c = std::cos(degrees * radians_per_degree);
    double s = std::sin(degrees * radians_per_degree);
    if (quarters == std::round(quarters)) {
        c = std::round(c);
        s = std::round(s);
    }
    Affine turn;
    turn.linear << c, -s, s, c;
    return turn;
}

Affine skew(double x_degrees, double y_degrees) {
    Affine result;
    result.linear << 1.0, std::tan(x_degrees * radians_per_degree), std::tan(y_degrees * radians_per_degree),
        1.0;
    return result;
}

/// The unit that CSS allows behind a number of a transform function; "" and "px" leave it as it is.
std::optional<double> unit_factor(std::string_view unit) {
    if (unit.empty() || unit == "px" || unit == "deg") return 1.0;
    if (unit == "rad") return 1.0 / radians_per_degree;
    if (unit == "grad") return 0.9;
    if (unit == "turn") return 360.0;
    return std::nullopt;
}

std::optional<std::vector<double>> arguments(Scanner& scanner) {
    std::vector<double> values;
    scanner.skip_space();
    if (!scanner.accept('(')) return std::nullopt;
    scanner.skip_space();
    while (!scanner.accept(')')) {
        const std::optional<double> value = scanner.number();
        if (!value) return std::nullopt;
        const std::optional<double> factor = unit_factor(scanner.word());
        if (!factor) return std::nullopt;
        values.push_back(*value * *factor);
        scanner.skip_separator();
    }
    return values;
}

std::optional<Affine> function(std::string_view name, const std::vector<double>& a) {
    const std::size_t n = a.size();
    if (name == "matrix" && n == 6) {
        Affine matrix;
        matrix.linear << a[0], a[2], a[1], a[3];
        matrix.shift << a[4], a[5];
        return matrix;
    }
    if (name == "translate" && (n == 1 || n == 2)) return translation({a[0], n == 2 ? a[1] : 0.0});
    if (name == "translateX" && n == 1) return translation({a[0], 0.0});
    if (name == "translateY" && n == 1) return translation({0.0, a[0]});
    if (name == "scale" && (n == 1 || n == 2)) return scaling(a[0], n == 2 ? a[1] : a[0]);
    if (name == "scaleX" && n == 1) return scaling(a[0], 1.0);
    if (name == "scaleY" && n == 1) return scaling(1.0, a[0]);
    if (name == "rotate" && n == 1) return rotation(a[0]);
    if (name == "rotate" && n == 3) {
        const Vec2 centre(a[1], a[2]);
        return translation(centre) * rotation(a[0]) * translation(-centre);
    }
    if (name == "skewX" && n == 1) return skew(a[0], 0.0);
    if (name == "skewY" && n == 1) return skew(0.0, a[0]);
    return std::nullopt;
}

/// Where along the free space an `xMin`, `xMid` or `xMax` puts the view box.
std::optional<double> alignment(std::string_view word) {
    if (word == "Min") return 0.0;
    if (word == "Mid") return 0.5;
    if (word == "Max") return 1.0;
    return std::nullopt;
}

}  // namespace

Affine translation(const Vec2& shift) {
    Affine result;
    result.shift = shift;
    return result;
}

Affine scaling(double x, double y) {
    Affine result;
    result.linear << x, 0.0, 0.0, y;
    return result;
}

Stretches stretches(const Mat2& linear) {
    // The singular values sigma_1 and sigma_2 from their sum of squares and their product.
    const double squares = linear.squaredNorm();
    const double product = std::abs(linear.determinant());
    const double root = std::sqrt(std::max(0.0, (squares - 2.0 * product) * (squares + 2.0 * product)));
    const double largest = std::sqrt(0.5 * (squares + root));
    return {largest, largest > 0.0 ? product / largest : 0.0};
}

std::optional<Affine> parse_transform(std::string_view text) {
    Affine result;
    Scanner scanner(trimmed(text));
    if (scanner.rest() == "none") return result;
    while (!scanner.at_end()) {
        const std::string_view name = scanner.word();
        const std::optional<std::vector<double>> values = arguments(scanner);
        if (!values) return std::nullopt;
        const std::optional<Affine> step = function(name, *values);
        if (!step) return std::nullopt;
        result = result * *step;
        scanner.skip_separator();
    }
    if (!result.finite()) return std::nullopt;
    return result;
}

std::optional<Box> parse_view_box(std::string_view text) {
    const std::vector<double> values = parse_numbers(text);
    if (values.size() != 4) return std::nullopt;
    return Box{{values[0], values[1]}, {values[2], values[3]}};
}

std::optional<Affine> fit_view_box(const Box& view_box, const Vec2& viewport, std::string_view aspect_ratio) {
    Scanner scanner(trimmed(aspect_ratio));
    std::string_view align = scanner.word();
    if (align == "defer") {
        scanner.skip_space();
        align = scanner.word();
    }
    scanner.skip_space();
    const std::string_view meet_or_slice = scanner.word();
    if (!scanner.at_end()) return std::nullopt;
    const Vec2 scales = viewport.cwiseQuotient(view_box.size);
    if (align == "none") {
        return scaling(scales.x(), scales.y()) * translation(-view_box.corner);
    }
    if (align.empty()) align = "xMidYMid";
    if (align.size() != 8 || align[0] != 'x' || align[4] != 'Y') return std::nullopt;
    const std::optional<double> x = alignment(align.substr(1, 3));
    const std::optional<double> y = alignment(align.substr(5, 3));
    const bool slice = meet_or_slice == "slice";
    if (!x || !y || (!slice && !meet_or_slice.empty() && meet_or_slice != "meet")) return std::nullopt;
    const double scale = slice ? scales.maxCoeff() : scales.minCoeff();
    const Vec2 free = viewport - scale * view_box.size;
    return translation(free.cwiseProduct(Vec2(*x, *y))) * scaling(scale, scale) *
           translation(-view_box.corner);
}

}  // namespace ruche::svg
