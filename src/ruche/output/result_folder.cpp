#include "ruche/output/result_folder.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "ruche/core/atomic_file.hpp"
#include "ruche/core/document.hpp"
#include "ruche/output/export_surface.hpp"
#include "ruche/output/exporters.hpp"
#include "ruche/output/image.hpp"
#include "ruche/output/picture.hpp"
#include "ruche/output/report.hpp"
#include "ruche/output/surface_fields.hpp"
#include "ruche/scene/state.hpp"
#include "ruche/scene/write_scene.hpp"

namespace ruche {

namespace fs = std::filesystem;

void check_result_folder(const std::string& folder) {
    std::error_code failed;
    fs::path existing = fs::absolute(folder, failed).lexically_normal();
    while (!existing.empty() && !fs::exists(existing, failed)) {
        if (existing == existing.parent_path()) break;
        existing = existing.parent_path();
    }
    if (!fs::is_directory(existing, failed))
        throw std::runtime_error(
            fmt::format("cannot write to {}: {} is a file, not a folder", folder, existing.string()));
    if (::access(existing.c_str(), W_OK | X_OK) != 0)
        throw std::runtime_error(
            fmt::format("cannot write to {}: {}", folder, std::generic_category().message(errno)));
}

bool holds_finished_result(const std::string& folder) {
    const std::string path = (fs::path(folder) / "report.json").string();
    std::error_code ignored;
    if (!fs::exists(path, ignored)) return false;
    constexpr std::size_t longest = 256U << 20U;
    try {
        const auto report = nlohmann::json::parse(read_file(path, "report", longest));
        return report.value("status", "") != "interrupted";
    } catch (const std::exception&) {
        return true;  // not ours, or damaged: rather keep it
    }
}

namespace {

/// Every file a result may consist of; those that are not written again are removed with the earlier result.
constexpr const char* all_names[] = {"report.json", "scene.toml",  "shape.obj",  "shape.mtl",  "shape.ply",
                                     "shape.vtu",   "shape.glb",   "layout.obj", "layout.mtl", "layout.ply",
                                     "layout.vtu",  "picture.png", "state.ruche"};

class PendingFolder {
  public:
    explicit PendingFolder(fs::path folder) : folder_(std::move(folder)) {
        std::error_code failed;
        created_ = !fs::exists(folder_, failed);
        fs::create_directories(folder_, failed);
        if (failed)
            throw std::runtime_error(
                fmt::format("cannot make the folder {}: {}", folder_.string(), failed.message()));
    }
    PendingFolder(const PendingFolder&) = delete;
    PendingFolder& operator=(const PendingFolder&) = delete;
    ~PendingFolder() {
        files_.clear();  // takes back what was not committed
        std::error_code ignored;
        if (created_) fs::remove(folder_, ignored);  // only when empty
    }

    void add(const std::string& name, const std::string& contents) {
        files_.emplace_back((folder_ / name).string(), contents);
    }

    std::vector<std::string> commit() {
        std::vector<std::string> paths;
        for (PendingFile& file : files_) {
            file.commit();
            paths.push_back(file.path());
        }
        return paths;
    }

  private:
    fs::path folder_;
    bool created_ = false;
    std::vector<PendingFile> files_;
};

void add_surfaces(PendingFolder& files, const Result& result) {
    const OutputOptions& wanted = result.scene.output;
    if (!wanted.obj && !wanted.ply && !wanted.vtu) return;
    const SurfaceFields fields = surface_fields(result, result.energy_density);
    const std::pair<std::string, ExportSurface> surfaces[] = {{"shape", released_surface(result, fields)},
                                                              {"layout", layout_surface(result, fields)}};
    for (const auto& [name, surface] : surfaces) {
        if (wanted.obj) files.add(name + ".obj", to_obj(surface, name + ".mtl"));
        if (wanted.obj) files.add(name + ".mtl", obj_materials());
        if (wanted.ply) files.add(name + ".ply", to_ply(surface));
        if (wanted.vtu) files.add(name + ".vtu", to_vtu(surface));
    }
}

void remove_leftovers(const std::string& folder, const std::vector<std::string>& written) {
    for (const char* name : all_names) {
        const fs::path path = fs::path(folder) / name;
        std::error_code ignored;
        if (std::find(written.begin(), written.end(), path.string()) == written.end())
            fs::remove(path, ignored);
    }
}

}  // namespace

std::vector<std::string> write_result(const Result& result, const std::string& folder) {
    check_result_folder(folder);
    PendingFolder files(folder);
    const std::string state = to_bytes(state_of(result));
    if (result.equilibrium.status == SolveStatus::interrupted && holds_finished_result(folder)) {
        files.add("state.ruche", state);
        return files.commit();
    }
    const OutputOptions& wanted = result.scene.output;
    add_surfaces(files, result);
    if (wanted.glb) files.add("shape.glb", to_glb(result));
    if (wanted.picture)
        files.add("picture.png", to_png(draw_picture(result, {.width_px = wanted.picture_width_px,
                                                              .height_px = wanted.picture_height_px,
                                                              .title = {}})));
    files.add("scene.toml", to_toml(result.scene, folder));
    files.add("state.ruche", state);
    files.add("report.json", report_json(result));
    const std::vector<std::string> written = files.commit();
    remove_leftovers(folder, written);
    return written;
}

}  // namespace ruche
