#include "ruche/output/result_folder.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <system_error>

#include "ruche/core/document.hpp"
#include "ruche/output/html_report.hpp"
#include "ruche/output/report.hpp"
#include "ruche/output/write_outputs.hpp"
#include "ruche/scene/release_film.hpp"
#include "ruche/scene/state.hpp"

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

static std::string folder_of(const std::string& result, int number) {
    return (fs::path(result) / alternative_folder(number)).string();
}

static void remove_alternatives(const std::string& folder, int first) {
    std::error_code ignored;
    for (int number = first; fs::exists(folder_of(folder, number), ignored); ++number)
        remove_outputs(folder_of(folder, number));
    fs::remove(fs::path(folder_of(folder, 1)).parent_path(), ignored);  // when it is empty
}

void add_film(Result& result, const Control& control) {
    if (!result.scene.output.page || !can_write_page()) return;
    const auto begin = std::chrono::steady_clock::now();
    result.film = film_release(result, control);
    result.seconds["film"] = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

std::vector<std::string> write_result(const Result& result, const std::string& folder,
                                      const Control& control) {
    check_result_folder(folder);
    if (result.equilibrium.status != SolveStatus::interrupted || !holds_finished_result(folder)) {
        std::vector<std::string> files = write_outputs(result, folder, control, result.energy_density);
        const auto listed = result.alternatives ? result.alternatives->shapes.size() : 0;
        remove_alternatives(folder, static_cast<int>(listed) + 1);
        return files;
    }
    const std::string path = (fs::path(folder) / "state.ruche").string();
    write_state(path, state_of(result));
    return {path};
}

std::vector<std::string> write_result(const ResultWithAlternatives& found, const std::string& folder,
                                      const Control& control) {
    std::vector<std::string> files;
    const auto add = [&](const std::vector<std::string>& more) {
        files.insert(files.end(), more.begin(), more.end());
    };
    for (std::size_t i = 0; i < found.shapes.size(); ++i)
        add(write_result(found.shapes[i], folder_of(folder, static_cast<int>(i) + 1), control));
    add(write_result(found.ordinary, folder, control));
    return files;
}

}  // namespace ruche
