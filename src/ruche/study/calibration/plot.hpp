#pragma once

#include <string>
#include <vector>

namespace ruche {

/// Points in the units of the axes.
struct PlotSeries {
    std::string label;   ///< in the legend; empty: not there
    std::string colour;  ///< of CSS
    std::vector<double> x, y;
    bool dots = false;    ///< single points; else a line
    bool dashed = false;  ///< of a line
    double size = 1.6;    ///< line width or radius of a point, px
    /// Error bars: smallest and largest y of each point; empty: none.
    std::vector<double> low, high;
};

struct Plot {
    std::string title, x_label, y_label;
    std::vector<PlotSeries> series;
    bool log_x = false;
    bool log_y = false;
    int width_px = 460, height_px = 330;
};

/// As an SVG element for an HTML page, at most some thousand points drawn per series.
std::string svg_plot(const Plot& plot);

/// Text with <, > and & replaced.
std::string html_escaped(const std::string& text);

/// A series of colours that differ in hue and lightness, for up to eight curves.
std::string plot_colour(std::size_t index);

}  // namespace ruche
