#include "ruche/output/write_outputs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <functional>
#include <stdexcept>
#include <system_error>

#include "ruche/core/atomic_file.hpp"
#include "ruche/output/exporters.hpp"
#include "ruche/output/html_report.hpp"
#include "ruche/output/picture.hpp"
#include "ruche/output/report.hpp"
#include "ruche/scene/state.hpp"
#include "ruche/scene/write_scene.hpp"

namespace ruche {
namespace {

namespace fs = std::filesystem;

constexpr std::array all_names = {"shape.obj",   "shape.mtl",   "shape.ply",   "shape.vtu",  "layout.obj",
                                  "layout.ply",  "layout.vtu",  "shape.glb",   "shape.stl",  "scene.toml",
                                  "state.ruche", "picture.png", "report.html", "report.json"};

/// A file to write: its name, and how its contents are made when its turn comes.
struct Output {
    std::string name;
    std::function<std::string()> contents;
};

/// In the order in which they take their places.
std::vector<Output> outputs(const Result& result, const std::string& folder, const ExportSurface& shape,
                            const ExportSurface& layout, const SurfaceFields& fields) {
    const OutputOptions& wanted = result.scene.output;
    std::vector<Output> list;
    if (wanted.obj) {
        list.push_back({"shape.obj", [&] { return to_obj(shape, "shape.mtl"); }});
        list.push_back({"layout.obj", [&] { return to_obj(layout, "shape.mtl"); }});
        list.push_back({"shape.mtl", [] { return obj_materials(); }});
    }
    if (wanted.ply) {
        list.push_back({"shape.ply", [&] { return to_ply(shape); }});
        list.push_back({"layout.ply", [&] { return to_ply(layout); }});
    }
    if (wanted.vtu) {
        list.push_back({"shape.vtu", [&] { return to_vtu(shape); }});
        list.push_back({"layout.vtu", [&] { return to_vtu(layout); }});
    }
    if (wanted.glb) list.push_back({"shape.glb", [&] { return to_glb(result); }});
    if (wanted.stl) list.push_back({"shape.stl", [&] { return to_stl(shape); }});
    if (wanted.picture)
        list.push_back({"picture.png", [&] {
                            return to_png(draw_picture(result, {.width_px = wanted.picture_width_px,
                                                                .height_px = wanted.picture_height_px}));
                        }});
    if (wanted.page && can_write_page())
        list.push_back({"report.html", [&] { return html_report(result, fields); }});
    list.push_back({"scene.toml", [&] { return to_toml(result.scene, folder); }});
    list.push_back({"state.ruche", [&] { return to_bytes(state_of(result)); }});
    list.push_back({"report.json", [&] { return report_json(result); }});
    return list;
}

void make_folder(const fs::path& dir) {
    std::error_code error;
    fs::create_directories(dir, error);
    if (!error && !fs::is_directory(dir)) error = std::make_error_code(std::errc::not_a_directory);
    if (error) throw std::runtime_error(fmt::format("cannot write {}: {}", dir.string(), error.message()));
}

/// Removes what an earlier result left and this one does not replace. Without an earlier report the files are
/// not ours.
void remove_leftovers(const fs::path& dir, const std::vector<PendingFile>& files) {
    std::error_code ignored;
    if (!fs::exists(dir / "report.json", ignored)) return;
    for (const char* name : all_names) {
        const std::string path = (dir / name).string();
        const bool replaced =
            std::any_of(files.begin(), files.end(), [&](const PendingFile& f) { return f.path() == path; });
        if (!replaced) fs::remove(path, ignored);
    }
}

}  // namespace

std::vector<std::string> write_outputs(const Result& result, const std::string& dir, const Control& control,
                                       std::span<const double> energy_density) {
    const fs::path folder = dir.empty() ? fs::path(".") : fs::path(dir);
    make_folder(folder);
    const SurfaceFields fields = surface_fields(result, energy_density);
    const ExportSurface shape = released_surface(result, fields), layout = layout_surface(result, fields);
    const std::string name = folder.string();
    const std::vector<Output> list = outputs(result, name, shape, layout, fields);
    std::vector<PendingFile> files;
    for (const Output& output : list) {
        control.say({.phase = "write",
                     .fraction = static_cast<double>(files.size()) / static_cast<double>(list.size()),
                     .text = output.name});
        files.emplace_back((folder / output.name).string(), output.contents());
    }
    remove_leftovers(folder, files);
    std::vector<std::string> written;
    for (PendingFile& file : files) {
        file.commit();
        written.push_back(file.path());
    }
    return written;
}

void remove_outputs(const std::string& dir) {
    std::error_code ignored;
    const fs::path folder = dir;
    if (!fs::exists(folder / "report.json", ignored)) return;
    for (const char* name : all_names) fs::remove(folder / name, ignored);
    fs::remove(folder, ignored);  // fails when something else is in it
}

}  // namespace ruche
