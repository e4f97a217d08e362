#include "ruche/output/result_folder.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <system_error>

#include "ruche/core/document.hpp"
#include "ruche/output/write_outputs.hpp"
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

std::vector<std::string> write_result(const Result& result, const std::string& folder,
                                      const Control& control) {
    check_result_folder(folder);
    if (result.equilibrium.status != SolveStatus::interrupted || !holds_finished_result(folder))
        return write_outputs(result, folder, control, result.energy_density);
    const std::string path = (fs::path(folder) / "state.ruche").string();
    write_state(path, state_of(result));
    return {path};
}

}  // namespace ruche
