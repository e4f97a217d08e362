#include "ruche/output/pen.hpp"

#include <algorithm>
#include <cmath>

#include "ruche/output/stroke_font.hpp"

namespace ruche {
namespace {

double distance_to_segment(const Vec2& p, const Vec2& a, const Vec2& b) {
    const Vec2 along = b - a;
    const double length2 = along.squaredNorm();
    const double t = length2 > 0.0 ? std::clamp((p - a).dot(along) / length2, 0.0, 1.0) : 0.0;
    return (p - a - t * along).norm();
}

}  // namespace

void Pen::blend(int x, int y, double coverage) {
    unsigned char* pixel = &image_.rgb[3 * (static_cast<std::size_t>(y) * image_.width + x)];
    for (int i = 0; i < 3; ++i)
        pixel[i] =
            static_cast<unsigned char>(std::lround(pixel[i] + coverage * (colour_.srgb[i] - pixel[i])));
}

void Pen::lines(const std::vector<std::vector<Vec2>>& strokes, double width) {
    const double reach = 0.5 * width + 1.0;
    Vec2 low = Vec2::Constant(1e9), high = Vec2::Constant(-1e9);
    for (const auto& stroke : strokes)
        for (const Vec2& p : stroke) {
            low = low.cwiseMin(p);
            high = high.cwiseMax(p);
        }
    const int left = std::max(0, static_cast<int>(low.x() - reach)),
              right = std::min(image_.width - 1, static_cast<int>(high.x() + reach)),
              top = std::max(0, static_cast<int>(low.y() - reach)),
              bottom = std::min(image_.height - 1, static_cast<int>(high.y() + reach));
    if (left > right || top > bottom) return;
    const int columns = right - left + 1;
    std::vector<double> cover(static_cast<std::size_t>(columns) * (bottom - top + 1), 0.0);
    for (const auto& stroke : strokes)
        for (std::size_t i = 0; i + 1 < stroke.size(); ++i) {
            const Vec2 &a = stroke[i], &b = stroke[i + 1];
            const int x0 = std::max(left, static_cast<int>(std::min(a.x(), b.x()) - reach)),
                      x1 = std::min(right, static_cast<int>(std::max(a.x(), b.x()) + reach)),
                      y0 = std::max(top, static_cast<int>(std::min(a.y(), b.y()) - reach)),
                      y1 = std::min(bottom, static_cast<int>(std::max(a.y(), b.y()) + reach));
            for (int y = y0; y <= y1; ++y)
                for (int x = x0; x <= x1; ++x) {
                    double& c = cover[static_cast<std::size_t>(y - top) * columns + (x - left)];
                    const double d = distance_to_segment(Vec2(x + 0.5, y + 0.5), a, b);
                    c = std::max(c, std::clamp(0.5 * width + 0.5 - d, 0.0, std::min(1.0, width)));
                }
        }
    for (int y = top; y <= bottom; ++y)
        for (int x = left; x <= right; ++x)
            blend(x, y, cover[static_cast<std::size_t>(y - top) * columns + (x - left)]);
}

void Pen::rounded_box(const Vec2& top_left, const Vec2& bottom_right, double radius) {
    const Vec2 middle = 0.5 * (top_left + bottom_right), half = 0.5 * (bottom_right - top_left);
    const int left = std::max(0, static_cast<int>(top_left.x()) - 1),
              right = std::min(image_.width - 1, static_cast<int>(bottom_right.x()) + 1),
              top = std::max(0, static_cast<int>(top_left.y()) - 1),
              bottom = std::min(image_.height - 1, static_cast<int>(bottom_right.y()) + 1);
    for (int y = top; y <= bottom; ++y)
        for (int x = left; x <= right; ++x) {
            const Vec2 off = (Vec2(x + 0.5, y + 0.5) - middle).cwiseAbs() - half + Vec2::Constant(radius);
            const double outside = off.cwiseMax(Vec2::Zero()).norm() + std::min(0.0, off.maxCoeff()) - radius;
            blend(x, y, std::clamp(0.5 - outside, 0.0, 1.0));
        }
}

void Pen::text(std::string_view utf8, const Vec2& at, const Style& style) {
    WrittenText written = write_text(utf8);
    const double share = style.anchor == Anchor::left ? 0.0 : style.anchor == Anchor::centre ? 0.5 : 1.0;
    for (auto& stroke : written.strokes)
        for (Vec2& p : stroke) p = at + style.cap_height * Vec2(p.x() - share * written.width, -p.y());
    lines(written.strokes, style.cap_height * style.weight);
}

double text_width(std::string_view utf8, double cap_height) { return cap_height * write_text(utf8).width; }

}  // namespace ruche
