#include "ruche/output/html_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "ruche/output/camera.hpp"
#include "ruche/output/caption.hpp"
#include "ruche/output/packed_arrays.hpp"
#include "ruche/output/page_template.hpp"
#include "ruche/output/palette.hpp"
#include "ruche/output/report.hpp"

namespace ruche {
namespace {

using Json = nlohmann::ordered_json;

std::string css(const Colour& colour) {
    return fmt::format("#{:02x}{:02x}{:02x}", colour.srgb[0], colour.srgb[1], colour.srgb[2]);
}

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

void append(std::vector<double>& list, const std::vector<Vec3>& points) {
    for (const Vec3& p : points) list.insert(list.end(), {p.x(), p.y(), p.z()});
}

void must_be_finite(const std::vector<double>& values) {
    if (!std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); }))
        throw std::runtime_error("cannot write the page: the shape has positions that are not finite");
}

/// Mesh, print and strips; names begin with `prefix`.
void add_layout(PackedArrays& arrays, const std::string& prefix, const PrintMesh& layout) {
    std::vector<int> triangles;
    std::vector<int> front_strip;
    std::vector<int> back_strip;
    std::vector<double> front;
    std::vector<double> back;
    for (std::size_t t = 0; t < layout.mesh.triangles.size(); ++t) {
        const Triangle& corners = layout.mesh.triangles[t];
        triangles.insert(triangles.end(), corners.begin(), corners.end());
        const StripPair strips = layout.strip.empty() ? StripPair{} : layout.strip[t];
        const Print print = layout.print.empty() ? Print{} : layout.print[t];
        front_strip.push_back(strips.front);
        back_strip.push_back(strips.back);
        front.push_back(print.front);
        back.push_back(print.back);
    }
    std::vector<double> flat;
    for (const Vec2& v : layout.mesh.vertices) flat.insert(flat.end(), {v.x(), v.y()});
    arrays.add_numbers(prefix + "triangles", triangles, 3);
    arrays.add_even(prefix + "layout_mm", flat, 2);
    arrays.add_even(prefix + "front_mm", front);
    arrays.add_even(prefix + "back_mm", back);
    arrays.add_numbers(prefix + "front_strip", front_strip);
    arrays.add_numbers(prefix + "back_strip", back_strip);
}

void add_shape(PackedArrays& arrays, const Result& result, const SurfaceFields& fields) {
    std::vector<double> shape;
    append(shape, result.shape);
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
    arrays.add_numbers("self_intersecting",
                       std::vector<int>(fields.passes_through.begin(), fields.passes_through.end()));
}

Json add_film(PackedArrays& arrays, const ReleaseFilm& film) {
    add_layout(arrays, "film_", film.layout);
    std::vector<double> positions;
    Json frames = Json::array();
    for (const FilmFrame& frame : film.frames) {
        append(positions, frame.shape);
        frames.push_back({{"share", frame.share}, {"prestretch", frame.prestretch}});
    }
    must_be_finite(positions);
    arrays.add_even("film_frames_mm", positions, 3);
    return {{"frames", frames}};
}

Json index_of(const PackedArrays& arrays) {
    Json index = Json::object();
    for (const PackedArray& array : arrays.list()) {
        Json entry = {
            {"type", array.type}, {"count", array.count}, {"components", array.components}, {"at", array.at}};
        if (!array.scale.empty()) {
            entry["origin"] = array.origin;
            entry["scale"] = array.scale;
        }
        index[array.name] = std::move(entry);
    }
    return index;
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

std::string html_report(const Result& result, const SurfaceFields& fields) {
    const std::string_view page = page_template();
    const std::size_t mark = page.find(page_data_mark);
    if (mark == std::string_view::npos) throw std::logic_error("the program was built without the page");
    PackedArrays arrays;
    add_layout(arrays, "", result.layout);
    add_shape(arrays, result, fields);
    Json about = page_of(result);
    if (result.film) about["film"] = add_film(arrays, *result.film);
    about["arrays"] = index_of(arrays);

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
