#include "ruche/study/silhouette/foreground.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/convex_hull_2.h>
#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "ruche/core/error.hpp"

namespace ruche {
namespace {

constexpr int fewest_pixels = 400;       // of an object: an arc has no shape below
constexpr double least_contrast = 20.0;  // of 255: between the mean levels of object and background

using Plane = Eigen::Matrix3d;  // a column per channel: value = (1, x, y) . column

/// The photo inside the box.
class Window {
  public:
    Window(const Image& photo, const PixelBox& box) : photo_(photo), box_(box) {}

    int width() const { return box_.width; }
    int height() const { return box_.height; }
    std::size_t size() const { return static_cast<std::size_t>(box_.width) * box_.height; }
    int x(std::size_t i) const { return static_cast<int>(i % static_cast<std::size_t>(box_.width)); }
    int y(std::size_t i) const { return static_cast<int>(i / static_cast<std::size_t>(box_.width)); }

    Vec3 colour(int x, int y) const {
        const std::size_t at = 3 * (static_cast<std::size_t>(y + box_.top) * photo_.width + x + box_.left);
        return Vec3(photo_.rgb[at], photo_.rgb[at + 1], photo_.rgb[at + 2]);
    }

    /// Where a plane has its coordinates: -1 to 1, about.
    Vec3 place(int x, int y) const { return Vec3(1.0, 2.0 * x / width() - 1.0, 2.0 * y / height() - 1.0); }

    double level(const Plane& background, int x, int y) const {
        return (colour(x, y) - background.transpose() * place(x, y)).norm();
    }

  private:
    const Image& photo_;
    PixelBox box_;
};

/// Pixels of a frame along the border, about ten thousand.
std::vector<std::array<int, 2>> frame_of(const Window& window) {
    const int thick = std::max(1, std::min(window.width(), window.height()) / 50);
    std::vector<std::array<int, 2>> all;
    for (int y = 0; y < window.height(); ++y) {
        const bool whole_row = y < thick || y >= window.height() - thick;
        for (int x = 0; x < window.width(); ++x) {
            if (!whole_row && x == thick) x = std::max(x, window.width() - thick);
            all.push_back({x, y});
        }
    }
    std::vector<std::array<int, 2>> some;
    const std::size_t step = std::max<std::size_t>(1, all.size() / 10000);
    for (std::size_t i = 0; i < all.size(); i += step) some.push_back(all[i]);
    return some;
}

Plane fit_background(const Window& window) {
    std::vector<std::array<int, 2>> used = frame_of(window);
    Plane plane = Plane::Zero();
    for (int round = 0; round < 3; ++round) {
        Mat3 normal = 1e-9 * Mat3::Identity();
        Mat3 right = Mat3::Zero();
        for (const auto& [x, y] : used) {
            const Vec3 place = window.place(x, y);
            normal += place * place.transpose();
            right += place * window.colour(x, y).transpose();
        }
        plane = normal.ldlt().solve(right);
        double squares = 0.0;
        for (const auto& [x, y] : used) squares += std::pow(window.level(plane, x, y), 2);
        constexpr double rounding = 1.0;  // colours are whole numbers
        const double far = 3.0 * std::max(rounding, std::sqrt(squares / static_cast<double>(used.size())));
        std::vector<std::array<int, 2>> near;
        for (const auto& [x, y] : used)
            if (window.level(plane, x, y) <= far) near.push_back({x, y});
        used = std::move(near);
    }
    return plane;
}

/// Otsu's threshold, and the mean levels on either side of it.
struct Classes {
    double threshold = 0.0;
    double below = 0.0;
    double above = 0.0;
};

Classes separate(const std::vector<float>& levels) {
    constexpr int bins = 512;
    constexpr double largest = 442.0;  // 255 sqrt(3)
    std::array<double, bins> count = {};
    for (const float level : levels)
        count[static_cast<std::size_t>(std::min(bins - 1.0, level * bins / largest))] += 1.0;
    const auto middle = [](int bin) { return (bin + 0.5) * largest / bins; };
    double all = 0.0;
    double all_sum = 0.0;
    for (int bin = 0; bin < bins; ++bin) {
        all += count[bin];
        all_sum += count[bin] * middle(bin);
    }
    Classes best;
    double most = -1.0;
    double low = 0.0;
    double low_sum = 0.0;
    for (int bin = 0; bin + 1 < bins; ++bin) {
        low += count[bin];
        low_sum += count[bin] * middle(bin);
        const double high = all - low;
        if (low == 0.0 || high == 0.0) continue;
        const double apart = low_sum / low - (all_sum - low_sum) / high;
        const double between = low * high * apart * apart;
        if (between <= most) continue;
        most = between;
        best = {.below = low_sum / low, .above = (all_sum - low_sum) / high};
    }
    // Anything between empty bins separates as well: half way between the classes lies an edge's middle.
    best.threshold = 0.5 * (best.below + best.above);
    return best;
}

/// The largest set of neighbours (of eight) above the threshold, as indices.
std::vector<std::size_t> largest_piece(const Window& window, const std::vector<float>& levels,
                                       double threshold) {
    std::vector<char> open(levels.size());
    for (std::size_t i = 0; i < levels.size(); ++i) open[i] = levels[i] >= threshold ? 1 : 0;
    std::vector<std::size_t> largest;
    for (std::size_t seed = 0; seed < open.size(); ++seed) {
        if (open[seed] == 0) continue;
        std::vector<std::size_t> piece = {seed};
        open[seed] = 0;
        for (std::size_t next = 0; next < piece.size(); ++next) {
            const int x = window.x(piece[next]);
            const int y = window.y(piece[next]);
            for (int v = std::max(0, y - 1); v <= std::min(window.height() - 1, y + 1); ++v)
                for (int u = std::max(0, x - 1); u <= std::min(window.width() - 1, x + 1); ++u) {
                    const std::size_t at = static_cast<std::size_t>(v) * window.width() + u;
                    if (open[at] == 0) continue;
                    open[at] = 0;
                    piece.push_back(at);
                }
        }
        if (piece.size() > largest.size()) largest = std::move(piece);
    }
    return largest;
}

std::vector<Vec2> convex_hull(const std::vector<Vec2>& points) {
    using Point = CGAL::Exact_predicates_inexact_constructions_kernel::Point_2;
    std::vector<Point> all;
    all.reserve(points.size());
    for (const Vec2& p : points) all.emplace_back(p.x(), p.y());
    std::vector<Point> corners;
    CGAL::convex_hull_2(all.begin(), all.end(), std::back_inserter(corners));
    std::vector<Vec2> hull;
    hull.reserve(corners.size());
    for (const Point& p : corners) hull.emplace_back(p.x(), p.y());
    return hull;
}

/// Ends of the piece in each row: all that a hull needs.
std::vector<Vec2> row_ends(const Window& window, const std::vector<std::size_t>& piece, const PixelBox& box) {
    std::vector<std::array<int, 2>> ends(static_cast<std::size_t>(window.height()), {window.width(), -1});
    for (const std::size_t i : piece) {
        auto& [left, right] = ends[static_cast<std::size_t>(window.y(i))];
        left = std::min(left, window.x(i));
        right = std::max(right, window.x(i));
    }
    std::vector<Vec2> points;
    for (int y = 0; y < window.height(); ++y)
        for (const int x : ends[static_cast<std::size_t>(y)])
            if (x >= 0 && x < window.width()) points.emplace_back(x + box.left, y + box.top);
    return points;
}

/// Only the piece and what lies next to it keeps its level: between the two lies the edge, as wide as it is
/// blurred.
void keep_piece(std::vector<float>& levels, const Window& window, const std::vector<std::size_t>& piece) {
    constexpr int reach = 3;
    std::vector<char> near(levels.size(), 0);
    for (const std::size_t i : piece) {
        const int x = window.x(i);
        const int y = window.y(i);
        for (int v = std::max(0, y - reach); v <= std::min(window.height() - 1, y + reach); ++v)
            for (int u = std::max(0, x - reach); u <= std::min(window.width() - 1, x + reach); ++u)
                near[static_cast<std::size_t>(v) * window.width() + u] = 1;
    }
    for (std::size_t i = 0; i < levels.size(); ++i)
        if (near[i] == 0) levels[i] = 0.0F;
}

bool touches_border(const Window& window, const std::vector<std::size_t>& piece) {
    return std::any_of(piece.begin(), piece.end(), [&](std::size_t i) {
        return window.x(i) == 0 || window.y(i) == 0 || window.x(i) == window.width() - 1 ||
               window.y(i) == window.height() - 1;
    });
}

PixelBox checked_box(const Image& photo, const std::optional<PixelBox>& box) {
    if (!box) return {0, 0, photo.width, photo.height};
    if (box->left < 0 || box->top < 0 || box->width < 3 || box->height < 3 ||
        box->left + box->width > photo.width || box->top + box->height > photo.height)
        throw InputError({.key = "--box"},
                         fmt::format("{},{},{},{} is not a part of the photo, which has {} x {} pixels",
                                     box->left, box->top, box->width, box->height, photo.width, photo.height),
                         "LEFT,TOP,WIDTH,HEIGHT in pixels from the photo's top left corner.");
    return *box;
}

}  // namespace

double Foreground::at(const Vec2& pixel) const {
    const double x = pixel.x() - box.left;
    const double y = pixel.y() - box.top;
    if (!(x >= 0.0 && y >= 0.0 && x < box.width - 1 && y < box.height - 1)) return 0.0;
    const int u = static_cast<int>(x);
    const int v = static_cast<int>(y);
    const float* row = level.data() + static_cast<std::size_t>(v) * box.width + u;
    const double across = x - u;
    const double down = y - v;
    return (1.0 - down) * ((1.0 - across) * row[0] + across * row[1]) +
           down * ((1.0 - across) * row[box.width] + across * row[box.width + 1]);
}

Foreground find_foreground(const Image& photo, const std::optional<PixelBox>& box, const std::string& file) {
    Foreground found{.box = checked_box(photo, box)};
    const Window window(photo, found.box);
    const Plane background = fit_background(window);
    found.level.resize(window.size());
    for (std::size_t i = 0; i < window.size(); ++i)
        found.level[i] = static_cast<float>(window.level(background, window.x(i), window.y(i)));
    const Classes classes = separate(found.level);
    if (classes.above - classes.below < least_contrast)
        throw InputError({.file = file}, "shows nothing that stands out from its background",
                         "Photograph the sheet before a plain background of another colour.");
    found.threshold = classes.threshold;
    const std::vector<std::size_t> piece = largest_piece(window, found.level, found.threshold);
    if (piece.size() < fewest_pixels)
        throw InputError({.file = file},
                         fmt::format("shows nothing larger than {} pixels before its background, at least {} "
                                     "are needed",
                                     piece.size(), fewest_pixels),
                         "A plain background helps, and --box LEFT,TOP,WIDTH,HEIGHT around the sheet.");
    if (touches_border(window, piece))
        throw InputError(
            {.file = file},
            fmt::format("what stands out most touches the border of the {}: its outline is not whole",
                        box ? "box" : "photo"),
            "The sheet needs some background all around it; with --box LEFT,TOP,WIDTH,HEIGHT only "
            "that part is looked at.");
    found.hull = convex_hull(row_ends(window, piece, found.box));
    keep_piece(found.level, window, piece);
    return found;
}

}  // namespace ruche
