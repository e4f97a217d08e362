#pragma once

#include <string_view>

#include "ruche/geometry/vectors.hpp"
#include "ruche/output/image.hpp"
#include "ruche/output/palette.hpp"

namespace ruche {

/// Draws smooth lines and writing on a picture. Positions in pixels from the top left, y downwards.
class Pen {
  public:
    Pen(Image& image, const Colour& colour) : image_(image), colour_(colour) {}

    /// Strokes with round ends; overlaps are not darker.
    void lines(const std::vector<std::vector<Vec2>>& strokes, double width);

    /// A filled rectangle with rounded corners.
    void rounded_box(const Vec2& top_left, const Vec2& bottom_right, double radius);

    enum class Anchor { left, centre, right };
    struct Style {
        double cap_height = 12.0;  ///< pixels
        double weight = 0.12;      ///< stroke width over cap height
        Anchor anchor = Anchor::left;
    };

    /// Writes on the base line at `at`.
    void text(std::string_view utf8, const Vec2& at, const Style& style);

  private:
    void blend(int x, int y, double coverage);

    Image& image_;
    Colour colour_;
};

/// Width of a line of text, pixels.
double text_width(std::string_view utf8, double cap_height);

}  // namespace ruche
