#pragma once

#include <vector>

#include "ruche/geometry/polygon.hpp"

namespace ruche {

/// The wanted edge length everywhere: given values on some regions, growing at a given rate away from them up
/// to a largest value. Kept on a square grid.
class SizeField {
  public:
    struct Options {
        double far_size = 2.0;  ///< mm
        double grading = 0.3;   ///< mm per mm
        double finest = 1.0;    ///< smallest size that `refine` will be called with, mm
    };

    SizeField(const Box& box, const Options& options);

    /// Asks for edges of at most `size` on a region and its borders.
    void refine(const Region& region, double size);

    /// Lets the sizes spread; call once, after all `refine`.
    void spread();

    double at(const Vec2& point) const;

    /// About how many triangles of these sizes the region holds.
    double expected_triangles(const Region& region) const;

  private:
    int column(double x) const;
    int row(double y) const;
    double& cell(int i, int j) { return sizes_[static_cast<std::size_t>(j) * columns_ + i]; }
    double cell(int i, int j) const { return sizes_[static_cast<std::size_t>(j) * columns_ + i]; }

    template <class Visit>
    void for_cells_inside(const Region& region, const Visit& visit) const;

    Options options_;
    Vec2 low_;
    double spacing_ = 1.0;
    int columns_ = 1;
    int rows_ = 1;
    std::vector<double> sizes_;
};

}  // namespace ruche
