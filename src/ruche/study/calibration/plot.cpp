#include "ruche/study/calibration/plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace ruche {
namespace {

/// From values to pixels, and where the ticks are.
class Axis {
  public:
    Axis(double low, double high, bool logarithmic, double from_px, double to_px)
        : logarithmic_(logarithmic), from_(from_px), to_(to_px) {
        if (logarithmic_) {
            low_ = std::floor(std::log10(low) + 1e-9);
            high_ = std::ceil(std::log10(high) - 1e-9);
            if (high_ <= low_) high_ = low_ + 1.0;
            for (double decade = low_; decade <= high_ + 0.5; decade += 1.0)
                ticks_.push_back(std::pow(10.0, decade));
            return;
        }
        if (!(high > low)) high = low + 1.0;
        const double raw = (high - low) / 5.0;
        const double power = std::pow(10.0, std::floor(std::log10(raw)));
        const double lead = raw / power;
        const double step = (lead < 1.5 ? 1.0 : lead < 3.5 ? 2.0 : lead < 7.5 ? 5.0 : 10.0) * power;
        low_ = step * std::floor(low / step + 1e-9);
        high_ = step * std::ceil(high / step - 1e-9);
        for (int i = 0; low_ + i * step <= high_ + 0.5 * step; ++i) {
            const double tick = low_ + i * step;
            ticks_.push_back(std::abs(tick) < 1e-9 * step ? 0.0 : tick);
        }
    }

    double operator()(double value) const {
        const double v = logarithmic_ ? std::log10(std::max(value, 1e-300)) : value;
        const double share = std::clamp((v - low_) / (high_ - low_), -0.02, 1.02);
        return from_ + share * (to_ - from_);
    }
    const std::vector<double>& ticks() const { return ticks_; }

  private:
    bool logarithmic_;
    double from_, to_;
    double low_ = 0.0, high_ = 1.0;
    std::vector<double> ticks_;
};

struct Range {
    double low = std::numeric_limits<double>::infinity();
    double high = -std::numeric_limits<double>::infinity();
    void add(double v, bool logarithmic) {
        if (!std::isfinite(v) || (logarithmic && v <= 0.0)) return;
        low = std::min(low, v);
        high = std::max(high, v);
    }
};

constexpr double left = 62.0, right = 14.0, top = 30.0, bottom = 46.0;

std::string points_of(const PlotSeries& series, const Axis& x, const Axis& y) {
    constexpr std::size_t most = 1500;
    const std::size_t stride = std::max<std::size_t>(1, series.x.size() / most);
    std::string text;
    for (std::size_t i = 0; i < series.x.size(); i += stride) {
        if (!std::isfinite(series.x[i]) || !std::isfinite(series.y[i])) continue;
        if (series.dots)
            text += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{}\"/>", x(series.x[i]),
                                y(series.y[i]), series.size);
        else
            text += fmt::format("{:.1f},{:.1f} ", x(series.x[i]), y(series.y[i]));
    }
    return text;
}

std::string error_bars_svg(const PlotSeries& series, const Axis& x, const Axis& y) {
    std::string text;
    for (std::size_t i = 0; i < series.low.size(); ++i)
        if (std::isfinite(series.low[i]) && std::isfinite(series.high[i]))
            text += fmt::format("<path d=\"M{0:.1f} {1:.1f}V{2:.1f}m-3 0h6m-3 0V{1:.1f}m-3 0h6\"/>",
                                x(series.x[i]), y(series.low[i]), y(series.high[i]));
    return text.empty() ? text : fmt::format("<g stroke=\"{}\" fill=\"none\">{}</g>\n", series.colour, text);
}

std::string series_svg(const PlotSeries& series, const Axis& x, const Axis& y) {
    const std::string points = points_of(series, x, y);
    if (series.dots) return fmt::format("<g fill=\"{}\">{}</g>\n", series.colour, points);
    return fmt::format("<polyline fill=\"none\" stroke=\"{}\" stroke-width=\"{}\"{} points=\"{}\"/>\n",
                       series.colour, series.size, series.dashed ? " stroke-dasharray=\"5 3\"" : "", points);
}

/// Beside the axes, where it covers no curve; 0 without labels.
double legend_width(const Plot& plot) {
    std::size_t longest = 0;
    for (const PlotSeries& series : plot.series) longest = std::max(longest, series.label.size());
    return longest == 0 ? 0.0 : 30.0 + 6.0 * static_cast<double>(longest);  // of letters of 11 px
}

std::string legend_svg(const Plot& plot) {
    std::string text;
    double y = top + 14.0;
    for (const PlotSeries& series : plot.series) {
        if (series.label.empty()) continue;
        const double x = plot.width_px;
        text +=
            series.dots
                ? fmt::format("<circle cx=\"{}\" cy=\"{}\" r=\"3\" fill=\"{}\"/>", x + 9.0, y - 4.0,
                              series.colour)
                : fmt::format(
                      "<line x1=\"{}\" y1=\"{}\" x2=\"{}\" y2=\"{}\" stroke=\"{}\" stroke-width=\"2\"{}/>", x,
                      y - 4.0, x + 18.0, y - 4.0, series.colour,
                      series.dashed ? " stroke-dasharray=\"5 3\"" : "");
        text += fmt::format("<text x=\"{}\" y=\"{}\">{}</text>\n", x + 24.0, y, html_escaped(series.label));
        y += 15.0;
    }
    return text;
}

}  // namespace

std::string html_escaped(const std::string& text) {
    std::string escaped;
    for (const char c : text) {
        if (c == '<')
            escaped += "&lt;";
        else if (c == '>')
            escaped += "&gt;";
        else if (c == '&')
            escaped += "&amp;";
        else if (c == '"')
            escaped += "&quot;";
        else
            escaped += c;
    }
    return escaped;
}

std::string plot_colour(std::size_t index) {
    // Okabe and Ito's palette, which people with colour blindness can tell apart.
    constexpr std::array<std::string_view, 8> colours = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                                         "#56b4e9", "#e69f00", "#000000", "#8a7a00"};
    return std::string(colours[index % colours.size()]);
}

std::string svg_plot(const Plot& plot) {
    Range xs, ys;
    for (const PlotSeries& series : plot.series) {
        for (std::size_t i = 0; i < series.x.size(); ++i) {
            xs.add(series.x[i], plot.log_x);
            ys.add(series.y[i], plot.log_y);
        }
        for (const double v : series.low) ys.add(v, plot.log_y);
        for (const double v : series.high) ys.add(v, plot.log_y);
    }
    if (xs.low > xs.high || ys.low > ys.high) return {};
    const double w = plot.width_px;
    const double h = plot.height_px;
    const Axis x(xs.low, xs.high, plot.log_x, left, w - right);
    const Axis y(ys.low, ys.high, plot.log_y, h - bottom, top);
    std::string svg = fmt::format(
        "<svg viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\" role=\"img\" aria-label=\"{2}\">\n"
        "<text class=\"title\" x=\"{3}\" y=\"18\">{2}</text>\n",
        plot.width_px + legend_width(plot), plot.height_px, html_escaped(plot.title), left);
    for (const double tick : x.ticks())
        svg += fmt::format(
            "<line class=\"grid\" x1=\"{0:.1f}\" x2=\"{0:.1f}\" y1=\"{1}\" y2=\"{2}\"/>"
            "<text x=\"{0:.1f}\" y=\"{3}\" text-anchor=\"middle\">{4:g}</text>\n",
            x(tick), top, h - bottom, h - bottom + 15.0, tick);
    for (const double tick : y.ticks())
        svg += fmt::format(
            "<line class=\"grid\" x1=\"{0}\" x2=\"{1}\" y1=\"{2:.1f}\" y2=\"{2:.1f}\"/>"
            "<text x=\"{3}\" y=\"{4:.1f}\" text-anchor=\"end\">{5:g}</text>\n",
            left, w - right, y(tick), left - 6.0, y(tick) + 4.0, tick);
    for (const PlotSeries& series : plot.series)
        svg += series_svg(series, x, y) + error_bars_svg(series, x, y);
    svg += legend_svg(plot);
    svg += fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">{}</text>\n", 0.5 * (left + w - right),
                       h - 10.0, html_escaped(plot.x_label));
    svg += fmt::format(
        "<text transform=\"translate(14,{}) rotate(-90)\" text-anchor=\"middle\">{}</text>\n</svg>\n",
        0.5 * (top + h - bottom), html_escaped(plot.y_label));
    return svg;
}

}  // namespace ruche
