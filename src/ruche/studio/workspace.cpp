#include "ruche/studio/workspace.hpp"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <system_error>

#include "ruche/core/atomic_file.hpp"
#include "ruche/core/document.hpp"
#include "ruche/core/error.hpp"
#include "ruche/studio/run_summary.hpp"

namespace ruche {

namespace fs = std::filesystem;

static constexpr int deepest = 3;
static constexpr std::array result_files = {
    "report.html", "report.json", "scene.toml",  "shape.obj",    "shape.mtl",    "shape.glb",     "shape.stl",
    "shape.ply",   "shape.vtu",   "picture.png", "compare.html", "compare.json", "silhouette.png"};
static constexpr std::array scan_endings = {".obj", ".ply", ".stl"};
static constexpr std::array photo_endings = {".png", ".jpg", ".jpeg"};

Workspace::Workspace(const std::string& folder) {
    std::error_code failed;
    root_ = fs::canonical(folder.empty() ? "." : folder, failed);
    if (failed || !fs::is_directory(root_, failed))
        throw InputError({.file = folder}, "is not a folder",
                         "The studio works in a folder that is there already.");
}

fs::path Workspace::inside(const std::string& relative) const {
    const fs::path path(relative);
    if (relative.empty() || relative.find('\0') != std::string::npos || path.is_absolute())
        throw OutsideFolder("not the name of a file in the folder");
    std::error_code failed;
    const fs::path real = fs::weakly_canonical(root_ / path, failed);
    const fs::path within = real.lexically_relative(root_);
    if (failed || within.empty() || *within.begin() == "..")
        throw OutsideFolder("this lies outside the folder that the studio works in");
    return real;
}

/// Names of the folder's own files with an ending, that lie in it without a link.
static std::vector<std::string> names(const fs::path& root, std::string_view ending) {
    std::vector<std::string> found;
    std::error_code failed;
    for (fs::directory_iterator i(root, failed), end; !failed && i != end; i.increment(failed)) {
        const std::string name = i->path().filename().string();
        std::error_code ignored;
        if (name.ends_with(ending) && name.front() != '.' && i->is_regular_file(ignored) &&
            !i->is_symlink(ignored))
            found.push_back(name);
    }
    std::sort(found.begin(), found.end());
    return found;
}

static bool has_entry(const fs::path& file, const char* entry) {
    try {
        return read_toml(file.string()).find(entry) != nullptr;
    } catch (const InputError&) {
        return false;
    }
}

static std::vector<std::string> names_with_entry(const fs::path& root, const char* entry) {
    std::vector<std::string> found = names(root, ".toml");
    std::erase_if(found, [&](const std::string& name) { return !has_entry(root / name, entry); });
    return found;
}

std::vector<std::string> Workspace::drawings() const { return names(root_, ".svg"); }
std::vector<std::string> Workspace::scenes() const { return names_with_entry(root_, "pattern"); }
std::vector<std::string> Workspace::cards() const { return names_with_entry(root_, "set"); }

std::vector<std::string> Workspace::scans() const {
    std::vector<std::string> found;
    for (const char* ending : scan_endings)
        for (std::string& name : names(root_, ending)) found.push_back(std::move(name));
    return found;
}

std::vector<RunEntry> Workspace::runs() {
    const std::scoped_lock lock(mutex_);
    std::vector<RunEntry> list;
    std::map<std::string, Known> known;
    std::error_code failed;
    // Links are not followed.
    fs::recursive_directory_iterator walk(root_, fs::directory_options::skip_permission_denied, failed);
    for (const fs::recursive_directory_iterator end; !failed && walk != end; walk.increment(failed)) {
        std::error_code ignored;
        if (!walk->is_directory(ignored) || walk->is_symlink(ignored)) continue;
        if (walk.depth() + 1 >= deepest || walk->path().filename().string().starts_with('.'))
            walk.disable_recursion_pending();
        const fs::path report = walk->path() / "report.json";
        const fs::file_time_type time = fs::last_write_time(report, ignored);
        if (ignored || fs::is_symlink(report, ignored)) continue;
        const std::string folder = walk->path().lexically_relative(root_).string();
        const auto before = known_.find(folder);
        if (before != known_.end() && before->second.time == time) {
            known.insert(*before);
        } else if (const std::string summary = run_summary(report.string()); !summary.empty()) {
            struct stat about = {};
            stat(report.c_str(), &about);
            known[folder] = {time,
                             {.folder = folder,
                              .written = static_cast<double>(about.st_mtim.tv_sec) +
                                         1e-9 * static_cast<double>(about.st_mtim.tv_nsec),
                              .summary = summary,
                              .page = fs::exists(walk->path() / "report.html", ignored)}};
        }
    }
    known_ = std::move(known);
    list.reserve(known_.size());
    for (const auto& [folder, run] : known_) {
        list.push_back(run.entry);
        std::error_code ignored;
        list.back().compared = fs::is_regular_file(root_ / folder / "compare.html", ignored);
        list.back().photographed = fs::is_regular_file(root_ / folder / "silhouette.png", ignored);
    }
    std::sort(list.begin(), list.end(),
              [](const RunEntry& a, const RunEntry& b) { return a.written > b.written; });
    return list;
}

static std::string clean_stem(const std::string& wanted, const char* otherwise) {
    std::string stem;
    for (const char c : fs::path(wanted).stem().string()) {
        const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                           c == '-' || c == '_';
        if (plain)
            stem += c;
        else if (!stem.empty() && stem.back() != '-')
            stem += '-';
    }
    constexpr std::size_t longest = 60;
    stem.resize(std::min(stem.size(), longest));
    while (stem.ends_with('-')) stem.pop_back();
    return stem.empty() ? otherwise : stem;
}

std::string Workspace::keep_drawing(const std::string& wanted, const std::string& text) const {
    if (text.find("<svg") == std::string::npos && text.find(":svg") == std::string::npos)
        throw InputError({.file = wanted}, "is not an SVG drawing",
                         "Save it as SVG: Inkscape, Illustrator and Rhino all do.");
    return keep(clean_stem(wanted, "drawing"), ".svg", text);
}

std::string Workspace::keep_measured(const std::string& wanted, const std::string& bytes) const {
    std::string ending = fs::path(wanted).extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
    const auto is_one_of = [&](const auto& endings) {
        return std::find(endings.begin(), endings.end(), ending) != endings.end();
    };
    if (is_one_of(photo_endings)) return keep(clean_stem(wanted, "photo"), ending, bytes);
    if (is_one_of(scan_endings)) return keep(clean_stem(wanted, "scan"), ending, bytes);
    throw InputError({.file = wanted}, "is neither a scan (OBJ, PLY, STL) nor a photo (PNG, JPEG)",
                     "Every scanner's program can save one of these.");
}

std::string Workspace::keep(const std::string& stem, const std::string& ending,
                            const std::string& bytes) const {
    for (int number = 1;; ++number) {
        const std::string name = number == 1 ? stem + ending : fmt::format("{}-{}{}", stem, number, ending);
        const fs::path path = root_ / name;
        std::error_code ignored;
        if (fs::exists(fs::symlink_status(path, ignored))) {
            constexpr std::size_t longest = 64U << 20U;
            if (!fs::is_regular_file(fs::symlink_status(path, ignored)) ||
                fs::file_size(path, ignored) != bytes.size() ||
                read_file(path.string(), "file", longest) != bytes)
                continue;
            return name;
        }
        write_file_atomically(path.string(), bytes);
        return name;
    }
}

std::string Workspace::new_result(const std::string& name, const std::vector<std::string>& taken) const {
    const std::string stem = clean_stem(name, "drawing");
    for (int number = 1;; ++number) {
        const std::string folder = number == 1 ? stem + ".out" : fmt::format("{}-{}.out", stem, number);
        std::error_code ignored;
        if (!fs::exists(fs::symlink_status(root_ / folder, ignored)) &&
            std::find(taken.begin(), taken.end(), folder) == taken.end())
            return folder;
    }
}

fs::path Workspace::served_file(const std::string& relative) const {
    const fs::path path = inside(relative);
    const std::string name = path.filename().string();
    std::error_code ignored;
    if (!fs::is_regular_file(path, ignored)) return {};
    const bool drawn = path.extension() == ".svg" || path.extension() == ".toml";
    const bool of_result = std::find(result_files.begin(), result_files.end(), name) != result_files.end() &&
                           fs::exists(path.parent_path() / "report.json", ignored);
    return drawn || of_result ? path : fs::path();
}

}  // namespace ruche
