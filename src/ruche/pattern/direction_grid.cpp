#include "ruche/pattern/direction_grid.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "ruche/core/document.hpp"
#include "ruche/core/error.hpp"
#include "ruche/core/text_scan.hpp"
#include "ruche/pattern/table_cells.hpp"

namespace ruche {
namespace {

constexpr std::size_t longest_grid_file = 64U << 20U;
constexpr double same_coordinate = 1e-6;  // mm; nearer ones are one

constexpr const char* grid_advice =
    "One node \"x_mm, y_mm, angle_deg, spacing_mm\" per line, in any order; every x that occurs needs every "
    "y that occurs.";

struct Column {
    std::string_view name;
    double low, high;
};
constexpr std::array<Column, 4> columns = {{
    {"x_mm", -1e5, 1e5},
    {"y_mm", -1e5, 1e5},
    {"angle_deg", -360.0, 360.0},
    {"spacing_mm", 0.2, 1e3},
}};

/// Reads the nodes of a file, line by line.
class NodeReader {
  public:
    explicit NodeReader(const std::string& file) : file_(file) {}

    std::vector<DirectionGrid::Node> read() {
        const std::string text = read_file(file_, "grid of directions", longest_grid_file);
        for (TextScan scan(without_byte_order_mark(text)); !scan.at_end();) {
            const std::vector<std::string_view> cells = table_cells(scan.take_line());
            line_ = scan.line();
            if (!cells.empty()) add_row(cells);
        }
        if (nodes_.empty()) throw InputError({.file = file_}, "no nodes in this file", grid_advice);
        return std::move(nodes_);
    }

  private:
    void add_row(const std::vector<std::string_view>& cells) {
        if (cells.size() != columns.size())
            fail("", fmt::format("{} columns, expected {}", cells.size(), columns.size()), grid_advice);
        const bool first = !started_;
        started_ = true;
        if (first && std::ranges::none_of(cells, [](std::string_view cell) {
                double ignored = 0.0;
                return read_number(cell, ignored);
            }))
            return read_header(cells);
        std::array<double, 4> values{};
        for (std::size_t c = 0; c < columns.size(); ++c) values[c] = value_of(columns[c], cells[place_[c]]);
        const double doubled = 2.0 * values[2] * M_PI / 180.0;
        nodes_.push_back({.at = Vec2(values[0], values[1]),
                          .doubled = Vec2(std::cos(doubled), std::sin(doubled)),
                          .spacing = values[3],
                          .line = line_});
    }

    /// Where in a row each column stands.
    void read_header(const std::vector<std::string_view>& cells) {
        for (std::size_t c = 0; c < columns.size(); ++c) {
            const auto found = std::ranges::find(cells, columns[c].name);
            if (found == cells.end())
                fail("", fmt::format("the header has no column \"{}\"", columns[c].name), grid_advice);
            place_[c] = static_cast<std::size_t>(found - cells.begin());
        }
    }

    double value_of(const Column& column, std::string_view cell) const {
        double value = 0.0;
        if (!read_finite(cell, value))
            fail(column.name, fmt::format("\"{}\" is not a finite number", cell.substr(0, 60)), grid_advice);
        if (value < column.low || value > column.high)
            fail(column.name, fmt::format("{} is outside [{}, {}]", value, column.low, column.high), "");
        return value;
    }

    [[noreturn]] void fail(std::string_view column, const std::string& problem, const char* advice) const {
        throw InputError({.file = file_, .line = line_, .key = std::string(column)}, problem, advice);
    }

    const std::string& file_;
    int line_ = 0;
    bool started_ = false;
    std::array<std::size_t, 4> place_ = {0, 1, 2, 3};
    std::vector<DirectionGrid::Node> nodes_;
};

/// The different values of a coordinate, ascending.
std::vector<double> different(std::vector<double> values) {
    std::ranges::sort(values);
    const auto same = [](double a, double b) { return b - a <= same_coordinate; };
    values.erase(std::unique(values.begin(), values.end(), same), values.end());
    return values;
}

/// Which of the ascending values this one is.
std::size_t index_in(const std::vector<double>& axis, double value) {
    return static_cast<std::size_t>(std::ranges::lower_bound(axis, value - same_coordinate) - axis.begin());
}

/// A share of the way from one value of the axis to the next.
struct Between {
    std::size_t index = 0;
    double share = 0.0;
};

Between between(const std::vector<double>& axis, double value) {
    const auto above = std::ranges::upper_bound(axis, value) - axis.begin();
    const auto last = static_cast<std::ptrdiff_t>(axis.size()) - 2;
    const auto i = static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(above - 1, 0, last));
    return {i, std::clamp((value - axis[i]) / (axis[i + 1] - axis[i]), 0.0, 1.0)};
}

/// The line of a row with a coordinate that hardly any other row has: a slip. 0 without one; `across` is how
/// many rows a coordinate of this axis should have.
int slipped_line(const std::vector<DirectionGrid::Node>& rows, int axis, const std::vector<double>& values,
                 std::size_t across) {
    std::vector<std::size_t> count(values.size(), 0);
    std::vector<int> line(values.size(), 0);
    for (const DirectionGrid::Node& row : rows) {
        const std::size_t i = index_in(values, row.at[axis]);
        ++count[i];
        line[i] = row.line;
    }
    const auto rarest = std::ranges::min_element(count);
    return 2 * *rarest < across ? line[static_cast<std::size_t>(rarest - count.begin())] : 0;
}

}  // namespace

DirectionGrid::DirectionGrid(const std::string& file) : file_(file) {
    const std::vector<Node> rows = NodeReader(file).read();
    std::vector<double> xs;
    std::vector<double> ys;
    for (const Node& node : rows) {
        xs.push_back(node.at.x());
        ys.push_back(node.at.y());
    }
    x_ = different(std::move(xs));
    y_ = different(std::move(ys));
    if (x_.size() < 2 || y_.size() < 2)
        throw InputError(
            {.file = file_},
            fmt::format("a grid of {} x {} nodes, expected at least 2 x 2", x_.size(), y_.size()),
            grid_advice);
    take_in_order(rows);
}

void DirectionGrid::take_in_order(const std::vector<Node>& rows) {
    // Sorted, the nodes are 0, 1, 2, ... of the grid; not stored by place, since rows that are no grid at all
    // would need a place for each pair of them.
    std::vector<std::pair<std::size_t, std::size_t>> order;
    for (std::size_t r = 0; r < rows.size(); ++r)
        order.emplace_back(index_in(y_, rows[r].at.y()) * x_.size() + index_in(x_, rows[r].at.x()), r);
    std::ranges::sort(order);
    for (std::size_t k = 0; k < order.size(); ++k) {
        const Node& node = rows[order[k].second];
        if (k > 0 && order[k].first == order[k - 1].first)
            throw InputError({.file = file_, .line = node.line},
                             fmt::format("the node x = {:g}, y = {:g} mm stands in line {} already",
                                         node.at.x(), node.at.y(), rows[order[k - 1].second].line));
        nodes_.push_back(node);
    }
    std::size_t gap = 0;
    while (gap < order.size() && order[gap].first == gap) ++gap;
    if (gap == x_.size() * y_.size()) return;
    const int slip = std::max(slipped_line(rows, 0, x_, y_.size()), slipped_line(rows, 1, y_, x_.size()));
    throw InputError({.file = file_, .line = slip},
                     fmt::format("there is no node at x = {:g}, y = {:g} mm: {} rows with {} different x and "
                                 "{} different y are no complete grid",
                                 x_[gap % x_.size()], y_[gap / x_.size()], rows.size(), x_.size(), y_.size()),
                     grid_advice);
}

void DirectionGrid::require_disc(double radius) const {
    const double reach = radius - same_coordinate;
    if (x_.front() <= -reach && x_.back() >= reach && y_.front() <= -reach && y_.back() >= reach) return;
    throw InputError({.file = file_},
                     fmt::format("the grid reaches over x from {:g} to {:g} and y from {:g} to {:g} mm, the "
                                 "fabric {:g} mm to all sides",
                                 x_.front(), x_.back(), y_.front(), y_.back(), radius),
                     "Give nodes for all of the fabric, or a smaller outer_mm.");
}

void DirectionGrid::require_spacing(double smallest, double width) const {
    const auto closest = std::ranges::min_element(nodes_, {}, &Node::spacing);
    if (closest->spacing >= smallest) return;
    throw InputError({.file = file_, .line = closest->line, .key = "spacing_mm"},
                     fmt::format("lines {:g} mm apart leave no room between strips of {:g} mm width",
                                 closest->spacing, width),
                     fmt::format("Give a spacing of at least {:.3g} mm.", smallest));
}

std::array<DirectionGrid::Corner, 4> DirectionGrid::corners(const Vec2& p) const {
    const Between x = between(x_, p.x());
    const Between y = between(y_, p.y());
    const std::size_t first = y.index * x_.size() + x.index;
    return {{{first, (1.0 - x.share) * (1.0 - y.share)},
             {first + 1, x.share * (1.0 - y.share)},
             {first + x_.size(), (1.0 - x.share) * y.share},
             {first + x_.size() + 1, x.share * y.share}}};
}

double DirectionGrid::angle(const Vec2& p) const {
    Vec2 doubled = Vec2::Zero();
    for (const Corner& corner : corners(p)) doubled += corner.weight * nodes_[corner.node].doubled;
    return 0.5 * std::atan2(doubled.y(), doubled.x());
}

double DirectionGrid::spacing(const Vec2& p) const {
    double spacing = 0.0;
    for (const Corner& corner : corners(p)) spacing += corner.weight * nodes_[corner.node].spacing;
    return spacing;
}

double DirectionGrid::largest_spacing() const {
    return std::ranges::max_element(nodes_, {}, &Node::spacing)->spacing;
}

}  // namespace ruche
