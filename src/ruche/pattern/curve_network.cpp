#include <fmt/format.h>

#include <cmath>
#include <map>
#include <set>

#include "ruche/core/document.hpp"
#include "ruche/core/error.hpp"
#include "ruche/core/text_scan.hpp"
#include "ruche/pattern/generators.hpp"
#include "ruche/pattern/table_cells.hpp"

namespace ruche {
namespace {

constexpr std::size_t longest_file = 64U << 20U;
constexpr double closest_points = 1e-6;  // mm; nearer points are one

constexpr const char* advice =
    "One point \"x, y\" in mm per line, an empty line between curves; or three columns \"curve, x, y\".";

struct Curve {
    std::string name;
    Polyline points;
};

/// Reads the curves of a file, line by line.
class CurveReader {
  public:
    explicit CurveReader(std::string file) : file_(std::move(file)) {}

    std::vector<Curve> read() {
        const std::string text = read_file(file_, "table of curves", longest_file);
        for (TextScan scan(without_byte_order_mark(text)); !scan.at_end();) {
            const std::string_view line = scan.take_line();
            line_ = scan.line();
            add_line(line);
        }
        if (curves_.empty()) throw InputError({.file = file_}, "no points in this file", advice);
        return std::move(curves_);
    }

  private:
    void add_line(std::string_view line) {
        const std::vector<std::string_view> cells = table_cells(line);
        if (cells.empty()) {
            // A comment does not end a curve, an empty line does.
            if (line.find_first_not_of(" \t\r") == std::string_view::npos) current_ = nullptr;
            return;
        }
        double x = 0;
        double y = 0;
        const bool named = cells.size() == 3;
        if (cells.size() < 2 || cells.size() > 3)
            fail(fmt::format("{} columns, expected 2 or 3", cells.size()));
        if (!read_finite(cells[named ? 1 : 0], x) || !read_finite(cells[named ? 2 : 1], y)) {
            if (columns_ == 0 && !header_seen_) {
                header_seen_ = true;
                return;
            }
            fail(fmt::format("\"{}\" is not a point", line.substr(0, 60)));
        }
        if (std::abs(x) > 1e5 || std::abs(y) > 1e5)
            fail(fmt::format("({}, {}) mm is more than 100 m away", x, y));
        if (columns_ != 0 && columns_ != cells.size()) fail("the number of columns changes");
        columns_ = cells.size();
        add_point(named ? cells[0] : std::string_view(), {x, y});
    }

    void add_point(std::string_view name, const Vec2& x) {
        Curve* curve = current_;
        if (columns_ == 3) {
            const auto [entry, is_new] = by_name_.try_emplace(std::string(name), curves_.size());
            if (is_new) curves_.push_back({std::string(name), {}});
            curve = &curves_[entry->second];
        } else if (curve == nullptr) {
            curves_.push_back({std::to_string(curves_.size() + 1), {}});
            curve = current_ = &curves_.back();
        }
        if (curve->points.empty() || (curve->points.back() - x).norm() > closest_points)
            curve->points.push_back(x);
    }

    [[noreturn]] void fail(const std::string& problem) const {
        throw InputError({.file = file_, .line = line_}, problem, advice);
    }

    std::string file_;
    int line_ = 0;
    bool header_seen_ = false;
    std::size_t columns_ = 0;
    std::vector<Curve> curves_;
    Curve* current_ = nullptr;  // of two-column files; set anew before curves_ grows
    std::map<std::string, std::size_t> by_name_;
};

/// "curve-" and what an XML id may hold of the name, made unique.
std::string id_for(const std::string& name, std::set<std::string>& taken) {
    std::string id = "curve-";
    for (const char c : name) {
        const bool plain =
            (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
        id += plain ? c : '-';
    }
    std::string unique = id;
    for (int k = 2; !taken.insert(unique).second; ++k) unique = fmt::format("{}-{}", id, k);
    return unique;
}

}  // namespace

template <>
std::span<const Field<CurveNetworkOptions>> fields<CurveNetworkOptions>() {
    using S = CurveNetworkOptions;
    static const Field<S> table[] = {
        {"file", &S::file, "", -infinity, infinity,
         "Text file of points: \"x, y\" in mm per line, an empty line between curves; or \"curve, x, y\"."},
        {"width_mm", &S::width, "mm", 0.1, 1e3, "Width of the printed lines."},
        {"cap", choice<&S::cap>(cap_names), "", 0, 0, "Shape of the ends."},
    };
    return table;
}

GeneratedPattern generate_curves(const CurveNetworkOptions& options) {
    if (options.file.empty()) throw InputError({.key = "file"}, "no file of curves is given", advice);
    GeneratedPattern result;
    std::set<std::string> taken;
    for (Curve& curve : CurveReader(options.file).read()) {
        DrawnLine line{std::move(curve.points), false};
        if (line.points.size() > 3 && (line.points.front() - line.points.back()).norm() <= closest_points) {
            line.closed = true;
            line.points.pop_back();
        }
        if (line.points.size() < 2) {
            result.warnings.push_back(
                fmt::format("{}: curve {} has a single point; it is not printed", options.file, curve.name));
            continue;
        }
        const LineCap cap = options.cap == StripCap::round ? LineCap::round : LineCap::butt;
        result.strips.push_back({.id = id_for(curve.name, taken),
                                 .lines = {std::move(line)},
                                 .width = options.width,
                                 .cap = cap});
    }
    if (result.strips.empty())
        throw InputError({.file = options.file}, "no curve has two different points", advice);
    return result;
}

}  // namespace ruche
