#include "ruche/meshing/size_field.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ruche {

namespace {

constexpr double most_cells = 1e6;

template <class Visit>
void for_borders(const Region& region, const Visit& visit) {
    const auto loop = [&](const Polyline& points) {
        for (std::size_t i = 0, j = points.size() - 1; i < points.size(); j = i++)
            visit(points[j], points[i]);
    };
    for (const Polygon& polygon : region) {
        loop(polygon.outer);
        for (const Polyline& hole : polygon.holes) loop(hole);
    }
}

}  // namespace

SizeField::SizeField(const Box& box, const Options& options) : options_(options), low_(box.low) {
    const Vec2 extent = box.high - box.low;
    const double coarse = std::sqrt(std::max(extent.prod(), 1e-12) / most_cells);
    spacing_ = std::max({0.5 * options.finest, coarse, extent.maxCoeff() / most_cells});
    columns_ = static_cast<int>(extent.x() / spacing_) + 1;
    rows_ = static_cast<int>(extent.y() / spacing_) + 1;
    sizes_.assign(static_cast<std::size_t>(columns_) * rows_, options.far_size);
}

int SizeField::column(double x) const {
    return static_cast<int>(std::clamp((x - low_.x()) / spacing_, 0.0, columns_ - 1.0));
}

int SizeField::row(double y) const {
    return static_cast<int>(std::clamp((y - low_.y()) / spacing_, 0.0, rows_ - 1.0));
}

// Cells whose centre lies inside, row by row between crossings of the border.
template <class Visit>
void SizeField::for_cells_inside(const Region& region, const Visit& visit) const {
    std::vector<std::vector<double>> crossings(rows_);
    for_borders(region, [&](const Vec2& a, const Vec2& b) {
        const Vec2& lower = a.y() < b.y() ? a : b;
        const Vec2& upper = a.y() < b.y() ? b : a;
        for (int j = row(lower.y()); j <= row(upper.y()); ++j) {
            const double y = low_.y() + (j + 0.5) * spacing_;
            if (y <= lower.y() || y > upper.y()) continue;
            const double t = (y - lower.y()) / (upper.y() - lower.y());
            crossings[j].push_back(lower.x() + t * (upper.x() - lower.x()));
        }
    });
    for (int j = 0; j < rows_; ++j) {
        std::vector<double>& x = crossings[j];
        std::sort(x.begin(), x.end());
        for (std::size_t k = 0; k + 1 < x.size(); k += 2) {
            for (int i = column(x[k] - 0.5 * spacing_); i <= column(x[k + 1]); ++i) {
                const double centre = low_.x() + (i + 0.5) * spacing_;
                if (centre > x[k] && centre <= x[k + 1]) visit(i, j);
            }
        }
    }
}

void SizeField::refine(const Region& region, double size) {
    const auto want = [&](int i, int j) { cell(i, j) = std::min(cell(i, j), size); };
    for_cells_inside(region, want);
    for_borders(region, [&](const Vec2& a, const Vec2& b) {
        const int steps = static_cast<int>(std::ceil((b - a).norm() / (0.5 * spacing_))) + 1;
        for (int k = 0; k <= steps; ++k) {
            const Vec2 p = a + (b - a) * (static_cast<double>(k) / steps);
            want(column(p.x()), row(p.y()));
        }
    });
}

// Two sweeps over the grid with the eight neighbours (Borgefors 1986): within 8 % of the distance.
void SizeField::spread() {
    const double straight = options_.grading * spacing_;
    const double diagonal = straight * std::numbers::sqrt2;
    const auto sweep = [&](int i, int j, int from) {
        double smallest = cell(i, j);
        const auto look = [&](int k, int l, double growth) {
            if (k >= 0 && k < columns_ && l >= 0 && l < rows_)
                smallest = std::min(smallest, cell(k, l) + growth);
        };
        look(i + from, j, straight);
        look(i, j + from, straight);
        look(i - 1, j + from, diagonal);
        look(i + 1, j + from, diagonal);
        cell(i, j) = smallest;
    };
    for (int j = 0; j < rows_; ++j) {
        for (int i = 0; i < columns_; ++i) sweep(i, j, -1);
    }
    for (int j = rows_ - 1; j >= 0; --j) {
        for (int i = columns_ - 1; i >= 0; --i) sweep(i, j, 1);
    }
}

double SizeField::at(const Vec2& point) const { return cell(column(point.x()), row(point.y())); }

double SizeField::expected_triangles(const Region& region) const {
    // An equilateral triangle has 0.43 of its squared edge; refined meshes have edges shorter than wanted.
    constexpr double area_per_squared_size = 0.35;
    double sum = 0.0;
    for_cells_inside(region, [&](int i, int j) {
        const double size = cell(i, j);
        sum += spacing_ * spacing_ / (area_per_squared_size * size * size);
    });
    return sum;
}

}  // namespace ruche
