#include "ruche/pattern/svg_page.hpp"

#include <fmt/format.h>

#include <cmath>

#include "ruche/pattern/svg_scanner.hpp"

namespace ruche::svg {

namespace {

const Vec2 css_default_size(300.0, 150.0);  // px; only percentages can refer to it

[[noreturn]] void fail(const SvgFile& file, const std::string& problem) {
    throw InputError(
        {file.path(), file.line(file.root()), "svg"}, problem,
        "The page's size is expected as width=\"120mm\" height=\"80mm\" viewBox=\"0 0 120 80\".");
}

/// Empty when absent, "auto" or a percentage: then the file does not say.
std::optional<Length> page_length(const SvgFile& file, const char* name) {
    const std::string_view text = trimmed(file.root().attribute(name).value());
    if (text.empty() || text == "auto") return std::nullopt;
    const std::optional<Length> length = parse_length(text);
    if (!length) fail(file, fmt::format("{}: '{}' is not a length", name, text.substr(0, 60)));
    if (length->unit == Unit::percent) return std::nullopt;
    if (!(length->value > 0.0)) fail(file, fmt::format("{}: '{}' is not positive", name, text));
    return length;
}

std::optional<Box> page_view_box(const SvgFile& file) {
    const pugi::xml_attribute attribute = file.root().attribute("viewBox");
    if (trimmed(attribute.value()).empty()) return std::nullopt;
    const std::optional<Box> box = parse_view_box(attribute.value());
    const std::string_view text = std::string_view(attribute.value()).substr(0, 60);
    if (!box) fail(file, fmt::format("viewBox: '{}' is not four numbers", text));
    if (!(box->size.minCoeff() > 0.0)) {
        fail(file, fmt::format("viewBox: '{}' has a width or height that is not positive", text));
    }
    return box;
}

void check_size(const SvgFile& file, const Vec2& size) {
    if (size.maxCoeff() <= largest_page && size.minCoeff() > 0.0) return;
    fail(file, fmt::format("the page is {:.4g} x {:.4g} mm; at most {:.0f} m are allowed", size.x(), size.y(),
                           largest_page / 1000.0));
}

std::string guess_text(const Vec2& size) {
    return fmt::format(
        "no physical size in the file: taken as 96 px per inch, the page is {:.2f} x {:.2f} mm (at "
        "Illustrator's 72 per inch it would be {:.2f} x {:.2f} mm); give width and height in mm in the file, "
        "or "
        "--width-mm",
        size.x(), size.y(), size.x() * 96.0 / 72.0, size.y() * 96.0 / 72.0);
}

Affine flipped(double mm_per_unit, double height) {
    Affine map;
    map.linear << mm_per_unit, 0.0, 0.0, -mm_per_unit;
    map.shift << 0.0, height;
    return map;
}

}  // namespace

std::optional<Page> page_of(const SvgFile& file, double width_mm, Warnings& warnings) {
    const std::optional<Length> width = page_length(file, "width"), height = page_length(file, "height");
    const std::optional<Box> box = page_view_box(file);
    if (!box && !(width && height)) return std::nullopt;
    Vec2 px;
    if (width && height) {
        px = {width->px(0.0), height->px(0.0)};
    } else if (width) {
        px = {width->px(0.0), width->px(0.0) / box->size.x() * box->size.y()};
    } else if (height) {
        px = {height->px(0.0) / box->size.y() * box->size.x(), height->px(0.0)};
    } else {
        px = box->size;
    }
    Page page;
    page.map.mm_per_px = width_mm > 0.0 ? width_mm / px.x() : mm_per_px;
    page.size = page.map.mm_per_px * px;
    check_size(file, page.size);
    const Place place{file.path(), file.line(file.root()), "svg"};
    const bool physical = (width && width->physical()) || (height && height->physical());
    if (!physical && !(width_mm > 0.0)) warnings.add(place, guess_text(page.size));

    page.map.to_mm = flipped(page.map.mm_per_px, page.size.y());
    page.map.user_size = px;
    if (box) {
        const std::string_view aspect = file.root().attribute("preserveAspectRatio").value();
        std::optional<Affine> fit = fit_view_box(*box, px, aspect);
        if (!fit) {
            warnings.add(place, fmt::format("preserveAspectRatio: '{}' cannot be read: ignored",
                                            aspect.substr(0, 60)));
            fit = fit_view_box(*box, px, "");
        }
        page.map.to_mm = page.map.to_mm * *fit;
        page.map.user_size = box->size;
    }
    return page;
}

PageMap measuring_map() { return {flipped(mm_per_px, 0.0), css_default_size, mm_per_px}; }

Page page_around(const SvgFile& file, const Vec2& low, const Vec2& high, double width_mm,
                 Warnings& warnings) {
    Page page;
    const Vec2 measured = high - low;
    const double scale = width_mm > 0.0 && measured.x() > 0.0 ? width_mm / measured.x() : 1.0;
    page.map = measuring_map();
    page.map.mm_per_px *= scale;
    page.map.to_mm.linear *= scale;
    page.map.to_mm.shift = -scale * low;
    page.size = scale * measured;
    const Place place{file.path(), file.line(file.root()), "svg"};
    warnings.add(place, "no width, height or viewBox: the page is taken around what is drawn");
    if (!(width_mm > 0.0)) warnings.add(place, guess_text(page.size));
    return page;
}

}  // namespace ruche::svg
