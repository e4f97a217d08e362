#include "ruche/output/html_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "ruche/output/camera.hpp"
#include "ruche/output/caption.hpp"
#include "ruche/output/packed_arrays.hpp"
#include "ruche/output/packed_sheet.hpp"
#include "ruche/output/page_template.hpp"
#include "ruche/output/palette.hpp"
#include "ruche/output/report.hpp"

namespace ruche {
namespace {

using Json = nlohmann::ordered_json;

/// JSON inside a script element: no "<" that HTML could understand.
std::string for_script(const std::string& json) {
    std::string safe;
    safe.reserve(json.size());
    for (const char c : json)
        if (c == '<')
            safe += "\\u003c";
        else
            safe += c;
    return safe;
}

std::string script(const char* id, const char* type, const std::string& content) {
    return fmt::format("<script id=\"{}\" type=\"{}\">{}</script>\n", id, type, content);
}

void must_be_finite(const std::vector<double>& values) {
    if (!std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); }))
        throw std::runtime_error("cannot write the page: the shape has positions that are not finite");
}

void add_shape(PackedArrays& arrays, const Result& result, const SurfaceFields& fields) {
    const std::vector<double> shape = coordinates(result.shape);
    must_be_finite(shape);
    arrays.add_even("shape_mm", shape, 3);
    std::vector<double> most;
    std::vector<double> least;
    for (const VertexCurvature& curvature : fields.vertex_curvature) {
        most.push_back(curvature.max);
        least.push_back(curvature.min);
    }
    arrays.add_relative("curvature_max_per_mm", most);
    arrays.add_relative("curvature_min_per_mm", least);
    arrays.add_even("stretch_max", fields.stretch_max);
    arrays.add_even("stretch_min", fields.stretch_min);
    if (!fields.energy_density.empty())
        arrays.add_relative("energy_density_mJ_per_mm2", fields.energy_density);
    if (!fields.scan_distance.empty()) arrays.add_relative("scan_distance_mm", fields.scan_distance);
    arrays.add_numbers("self_intersecting",
                       std::vector<int>(fields.passes_through.begin(), fields.passes_through.end()));
}

Json add_film(PackedArrays& arrays, const ReleaseFilm& film) {
    add_layout(arrays, "film_", film.layout);
    std::vector<double> positions;
    Json frames = Json::array();
    for (const FilmFrame& frame : film.frames) {
        const std::vector<double> frame_positions = coordinates(frame.shape);
        positions.insert(positions.end(), frame_positions.begin(), frame_positions.end());
        frames.push_back({{"share", frame.share}, {"prestretch", frame.prestretch}});
    }
    must_be_finite(positions);
    arrays.add_even("film_frames_mm", positions, 3);
    return {{"frames", frames}};
}

Json page_of(const Result& result) {
    const Caption caption = make_caption(result, "");
    const View view = choose_view(result);
    Json page;
    page["title"] = caption.title;
    page["details"] = caption.details;
    page["alarm"] = caption.alarm;
    Json rotation = Json::array();
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column) rotation.push_back(view.placement.rotation(row, column));
    page["rotation"] = std::move(rotation);
    page["elevation_deg"] = view.elevation_deg;
    page["fabric_thickness_mm"] = result.scene.material.fabric_thickness;
    page["colours"] = {{"fabric", css(palette::fabric)},
                       {"plastic_front", css(palette::plastic_front)},
                       {"plastic_back", css(palette::plastic_back)},
                       {"alarm", css(palette::alarm)}};
    return page;
}

}  // namespace

bool can_write_page() { return !page_template().empty(); }

std::string html_report(const Result& result, const SurfaceFields& fields, const std::string& comparison) {
    const std::string_view page = page_template();
    const std::size_t mark = page.find(page_data_mark);
    if (mark == std::string_view::npos) throw std::logic_error("the program was built without the page");
    PackedArrays arrays;
    add_layout(arrays, "", result.layout);
    add_shape(arrays, result, fields);
    Json about = page_of(result);
    if (!comparison.empty()) about["comparison"] = Json::parse(comparison);
    if (result.film) about["film"] = add_film(arrays, *result.film);
    about["arrays"] = Json::parse(index_json(arrays));

    std::string html(page.substr(0, mark));
    const auto dump = [](const Json& json) {
        return json.dump(-1, ' ', false, Json::error_handler_t::replace);
    };
    html += script("ruche-report", "application/json", for_script(dump(Json::parse(report_json(result)))));
    html += script("ruche-page", "application/json", for_script(dump(about)));
    html += script("ruche-arrays", "application/octet-stream", base64(arrays.bytes()));
    html += page.substr(mark + page_data_mark.size());
    return html;
}

}  // namespace ruche
