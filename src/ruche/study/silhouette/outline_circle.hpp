#pragma once

#include <string>
#include <vector>

#include "ruche/study/silhouette/foreground.hpp"

namespace ruche {

/// The circle around an object in a photo; all in pixels.
struct OutlineCircle {
    Vec2 centre = Vec2::Zero();
    double radius = 0.0;
    double rms = 0.0;          ///< distance of the outline to the circle, where it belongs to it
    double arc_deg = 0.0;      ///< over which the outline follows the circle
    double followed = 0.0;     ///< share of the outline's outer side that lies on the circle
    std::vector<Vec2> points;  ///< those of the outline that the circle was fitted to
    /// Standard errors relative to the radius: from leaving out a tenth of the arc in turn (the outline's
    /// bumps, which have neighbours alike), and from where between object and background its edge is.
    double fit_error = 0.0;
    double edge_error = 0.0;
};

/// Fits a circle to the outer side of an object's outline. From the circle through the convex hull on, rays
/// towards the centre find where they meet the object first, to a part of a pixel; the circle is fitted to
/// these points (geometric least squares), and those farther off than three deviations (median) are left out
/// until nothing changes. Ends, the inner side and whatever is seen through an open roll do not count.
/// Throws InputError, naming `file`, where there is no arc to speak of.
OutlineCircle fit_outline_circle(const Foreground& object, const std::string& file);

}  // namespace ruche
