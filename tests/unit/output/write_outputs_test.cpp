#include "ruche/output/write_outputs.hpp"

#include <doctest/doctest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>

#include "output/sample_results.hpp"
#include "ruche/output/html_report.hpp"

using namespace ruche;
namespace fs = std::filesystem;

namespace {

struct Folder {
    fs::path path = fs::temp_directory_path() / ("ruche outputs ü " + std::to_string(::getpid()));
    Folder() { fs::remove_all(path); }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    ~Folder() { fs::remove_all(path); }
};

std::map<std::string, std::string> contents(const fs::path& dir) {
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::directory_iterator(dir)) {
        std::ostringstream text;
        text << std::ifstream(entry.path(), std::ios::binary).rdbuf();
        files[entry.path().filename().string()] = text.str();
    }
    return files;
}

Result small_result() {
    Result result = sample::rolled_sheet();
    result.scene.output.picture_width_px = 80;
    result.scene.output.picture_height_px = 64;
    return result;
}

}  // namespace

TEST_CASE("outputs: all that the scene asks for, into a folder that is made, report.json last") {
    const Folder folder;
    int reports = 0;
    const Control control{.report = [&](const Progress& p) {
        CHECK(p.phase == "write");
        ++reports;
    }};
    const auto written = write_outputs(small_result(), (folder.path / "a").string(), control);
    const auto files = contents(folder.path / "a");
    const int all = can_write_page() ? 13 : 12;
    CHECK(files.size() == all);
    CHECK(written.size() == all);
    CHECK(reports == all);
    CHECK(files.count("report.html") == (can_write_page() ? 1 : 0));
    CHECK(fs::path(written.back()).filename() == "report.json");
    CHECK(nlohmann::json::parse(files.at("report.json"))["status"] == "converged");
    CHECK(files.at("picture.png").starts_with("\x89PNG"));
}

TEST_CASE("outputs: a second result replaces the first, leaves foreign files and removes its own leftovers") {
    const Folder folder;
    Result result = small_result();
    write_outputs(result, folder.path.string());
    std::ofstream(folder.path / "notes.txt") << "mine";
    result.scene.output = {
        .obj = false, .ply = true, .vtu = false, .glb = false, .picture = false, .page = false};
    write_outputs(result, folder.path.string());
    const auto files = contents(folder.path);
    CHECK(files.size() == 6);
    for (const char* name :
         {"shape.ply", "layout.ply", "scene.toml", "state.ruche", "report.json", "notes.txt"})
        CHECK(files.count(name) == 1);
}

TEST_CASE("outputs: when one file cannot be written, every file of the earlier result is as it was") {
    const Folder folder;
    write_outputs(small_result(), folder.path.string());
    const auto before = contents(folder.path);
    Result other = small_result();
    other.shape[0].z() += 0.5;
    rlimit limit = {};
    getrlimit(RLIMIT_FSIZE, &limit);
    const rlimit lowered = {200000, limit.rlim_max};
    setrlimit(RLIMIT_FSIZE, &lowered);
    std::string message;
    try {
        write_outputs(other, folder.path.string());
    } catch (const std::runtime_error& e) {
        message = e.what();
    }
    setrlimit(RLIMIT_FSIZE, &limit);
    CHECK(message.find("File too large") != std::string::npos);
    CHECK(contents(folder.path) == before);
}

TEST_CASE("outputs: a file where the folder should be is an error that names it") {
    const Folder folder;
    fs::create_directories(folder.path);
    const std::string path = (folder.path / "taken").string();
    std::ofstream(path) << "x";
    CHECK_THROWS_WITH_AS(write_outputs(small_result(), path), doctest::Contains("taken"), std::runtime_error);
    CHECK(contents(folder.path).at("taken") == "x");
}
