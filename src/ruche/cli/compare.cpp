#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <map>
#include <memory>

#include "ruche/cli/progress_display.hpp"
#include "ruche/cli/verbs.hpp"
#include "ruche/core/atomic_file.hpp"
#include "ruche/output/html_report.hpp"
#include "ruche/output/result_folder.hpp"
#include "ruche/scene/read_result.hpp"
#include "ruche/study/scan/scan_comparison.hpp"

namespace ruche {

namespace {
struct CompareArguments {
    std::string result;
    std::string scan;
    std::string folder;
    ScanOptions options;
};
}  // namespace

static void print_comparison(const ScanComparison& found) {
    fmt::print("unit       {}{}\n", found.unit,
               found.unit_guessed ? " (guessed from the sizes; --unit says it)" : "");
    const Placing& placing = found.registration.placing;
    if (placing.scale != 1.0)
        fmt::print("scale      {:.5g}: the scan was made {} to fit\n", placing.scale,
                   placing.scale > 1.0 ? "larger" : "smaller");
    fmt::print("skin       {}\n", name_of(found.skin));
    fmt::print(
        "distance   {:.3g} mm root mean square of {} points, {:+.3g} mm on average (positive: outside)\n",
        found.rms, found.points, found.mean);
    for (const auto& [percent, value] : found.percentiles)
        fmt::print("           {:.0f} % within {:.3g} mm\n", percent, value);
    fmt::print("covered    {:.0f} % of the sheet\n", 100.0 * found.covered);
    for (const std::string& warning : found.warnings) fmt::print("warning: {}\n", warning);
}

static ExitCode run(const CompareArguments& arguments) {
    namespace fs = std::filesystem;
    const std::string folder = arguments.folder.empty() ? arguments.result : arguments.folder;
    check_result_folder(folder);
    const RawMesh scan = read_surface(arguments.scan);
    const Result result = read_result(arguments.result);
    SurfaceFields fields = surface_fields(result, result.energy_density);
    ProgressDisplay display;
    const ScanComparison found =
        compare_with_scan(result, fields, scan, arguments.options,
                          {.report = [&](const Progress& progress) { display.show(progress); }});
    display.clear();
    fs::create_directories(folder);
    const std::string json = to_json(found, arguments.scan);
    std::vector<std::string> written = {(fs::path(folder) / "compare.json").string()};
    write_file_atomically(written.back(), json);
    if (can_write_page()) {
        fields.scan_distance = found.vertex_distance;
        written.push_back((fs::path(folder) / "compare.html").string());
        write_file_atomically(written.back(), html_report(result, fields, json));
    }
    print_comparison(found);
    fmt::print("written:\n");
    for (const std::string& path : written) fmt::print("  {}\n", path);
    return ExitCode::converged;
}

void add_compare(CLI::App& program, Action& action) {
    const auto arguments = std::make_shared<CompareArguments>();
    CLI::App* verb = program.add_subcommand("compare", "Compare a result with a scan of what was made");
    verb->add_option("result", arguments->result, "Folder of a result")->required()->type_name("RESULT");
    verb->add_option("scan", arguments->scan, "Scan of the made piece, also of a part of it: OBJ, PLY or STL")
        ->required()
        ->type_name("SCAN");
    verb->add_option("-o,--output", arguments->folder,
                     "Folder for compare.json and compare.html; else RESULT")
        ->type_name("DIR");
    verb->add_option("--unit", arguments->options.unit,
                     "Unit of the scan: mm, cm, m or inch; else guessed and said")
        ->type_name("UNIT");
    const std::map<std::string, Skin> skins = {
        {"automatic", Skin::automatic}, {"front", Skin::front}, {"back", Skin::back}, {"both", Skin::both}};
    verb->add_option("--skin", arguments->options.skin,
                     "What the scanner saw: front, back or both; else the best")
        ->transform(CLI::CheckedTransformer(skins, CLI::ignore_case).description(""))
        ->type_name("SIDE");
    verb->add_option("--kept", arguments->options.kept,
                     "Share of the scan that certainly is of the sheet; the rest may be its support")
        ->check(CLI::Range(0.1, 1.0))
        ->type_name("SHARE");
    verb->add_flag("--free-scale", arguments->options.free_scale,
                   "Let the scan's size change to fit; the scale is said");
    verb->callback([arguments, &action] { action = [arguments] { return run(*arguments); }; });
}

}  // namespace ruche
