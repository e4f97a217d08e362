#pragma once

#include <array>
#include <string>
#include <vector>

#include "ruche/geometry/vectors.hpp"

namespace ruche {

/// Directions of strips, and distances between their centre lines, given at the nodes of a grid over the
/// layout.
///
/// The file has a line "x_mm, y_mm, angle_deg, spacing_mm" per node, in any order, angles from the layout's x
/// axis. Every x that occurs needs every y that occurs; steps may differ. A header may put the columns in
/// another order; '#' starts a comment.
///
/// Between nodes both are bilinear, directions by their doubled angle: (cos 2a, sin 2a), since a line has no
/// sign and a + 180 degrees is the same one. Where these vectors cancel lies a singular point of the field.
class DirectionGrid {
  public:
    struct Node {
        Vec2 at = Vec2::Zero();       ///< mm
        Vec2 doubled = Vec2::Zero();  ///< (cos, sin) of twice the angle
        double spacing = 0.0;         ///< mm
        int line = 0;                 ///< of the file
    };

    /// Reads a file. Throws InputError with its name, and with the line where one is to blame.
    explicit DirectionGrid(const std::string& file);

    /// Throws InputError when the grid does not reach over the disc of this radius around the origin.
    void require_disc(double radius) const;
    /// Throws InputError, with the line, when a spacing is smaller than strips of this width allow.
    void require_spacing(double smallest, double width) const;

    double angle(const Vec2& p) const;    ///< radians, in (-pi/2, pi/2]; outside the grid as on its border
    double spacing(const Vec2& p) const;  ///< mm
    double largest_spacing() const;

  private:
    struct Corner {
        std::size_t node = 0;
        double weight = 0.0;
    };
    void take_in_order(const std::vector<Node>& rows);
    std::array<Corner, 4> corners(const Vec2& p) const;

    std::string file_;
    std::vector<double> x_, y_;  // ascending
    std::vector<Node> nodes_;    // row by row: y_.size() rows of x_.size()
};

}  // namespace ruche
