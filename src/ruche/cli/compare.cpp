#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <filesystem>
#include <map>
#include <memory>

#include "ruche/cli/progress_display.hpp"
#include "ruche/cli/verbs.hpp"
#include "ruche/core/error.hpp"
#include "ruche/output/result_folder.hpp"
#include "ruche/study/scan/scan_files.hpp"
#include "ruche/study/silhouette/photo.hpp"
#include "ruche/study/silhouette/silhouette_files.hpp"

namespace ruche {

namespace {
struct CompareArguments {
    std::string result;
    std::string made;  ///< the scan or the photo
    std::string folder;
    ScanOptions options;
    SilhouetteOptions silhouette;
    std::vector<int> box;
    std::vector<std::string> of_scans;   ///< options given that say something about a scan
    std::vector<std::string> of_photos;  ///< about a photo
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

static void print_silhouette(const SilhouetteComparison& found) {
    const OutlineCircle& outline = found.outline;
    fmt::print(
        "photo      curvature {:.5f} +- {:.5f} /mm, radius {:.2f} mm (one standard error: {:.2g} % by the "
        "fit, {:.2g} % by the edge, {:.2g} % by the scale)\n",
        found.curvature, found.uncertainty, 1.0 / found.curvature, 100.0 * outline.fit_error,
        100.0 * outline.edge_error, 100.0 * found.scale_error);
    fmt::print("           {:.0f} degrees of arc, {:.2g} mm root mean square off the circle\n",
               outline.arc_deg, found.mm_per_px * outline.rms);
    fmt::print(
        "result     curvature {:.5f} /mm, radius {:.2f} mm, of its outline ({:.5f} /mm of its reference "
        "surface)\n",
        found.result_outline_curvature, 1.0 / found.result_outline_curvature, found.result_curvature);
    fmt::print("difference {:+.1f} %, {:.1f} standard errors: what was made is bent {}\n",
               100.0 * found.difference(),
               std::abs(found.curvature - found.result_outline_curvature) / found.uncertainty,
               found.difference() > 0.0 ? "more" : "less");
    for (const std::string& warning : found.warnings) fmt::print("warning: {}\n", warning);
}

/// What was written, by the names of the files.
using Written = std::vector<std::string>;

static Written compare_scan(const CompareArguments& arguments, const std::filesystem::path& folder) {
    ProgressDisplay display;
    const WrittenComparison written =
        compare_files(arguments.result, arguments.made, folder.string(), arguments.options,
                      {.report = [&](const Progress& progress) { display.show(progress); }});
    display.clear();
    print_comparison(written.found);
    return written.paths;
}

static Written compare_photo(const CompareArguments& arguments, const std::filesystem::path& folder) {
    SilhouetteOptions options = arguments.silhouette;
    if (!arguments.box.empty())
        options.box = {arguments.box[0], arguments.box[1], arguments.box[2], arguments.box[3]};
    const WrittenSilhouette written =
        compare_silhouette_files(arguments.result, arguments.made, folder.string(), options);
    print_silhouette(written.found);
    return written.paths;
}

static ExitCode run(const CompareArguments& arguments) {
    const std::string folder = arguments.folder.empty() ? arguments.result : arguments.folder;
    check_result_folder(folder);
    const bool photo = is_photo(arguments.made);
    for (const std::string& option : photo ? arguments.of_scans : arguments.of_photos)
        throw InputError({.key = option},
                         fmt::format("is for {}, {} is a {}", photo ? "scans" : "photos", arguments.made,
                                     photo ? "photo" : "scan"),
                         "Leave it out.");
    const Written written = photo ? compare_photo(arguments, folder) : compare_scan(arguments, folder);
    fmt::print("written:\n");
    for (const std::string& path : written) fmt::print("  {}\n", path);
    return ExitCode::converged;
}

static void add_scan_options(CLI::App& verb, ScanOptions& options) {
    verb.add_option("--unit", options.unit, "Unit of the scan: mm, cm, m or inch; else guessed and said")
        ->type_name("UNIT");
    const std::map<std::string, Skin> skins = {
        {"automatic", Skin::automatic}, {"front", Skin::front}, {"back", Skin::back}, {"both", Skin::both}};
    verb.add_option("--skin", options.skin, "What the scanner saw: front, back or both; else the best")
        ->transform(CLI::CheckedTransformer(skins, CLI::ignore_case).description(""))
        ->type_name("SIDE");
    verb.add_option("--kept", options.kept,
                    "Share of the scan that certainly is of the sheet; the rest may be its support")
        ->check(CLI::Range(0.1, 1.0))
        ->type_name("SHARE");
    verb.add_flag("--free-scale", options.free_scale, "Let the scan's size change to fit; the scale is said");
}

static void add_photo_options(CLI::App& verb, CompareArguments& arguments) {
    SilhouetteOptions& options = arguments.silhouette;
    verb.add_option("--known-length-mm", options.known_length_mm,
                    "Photo: a length in it, as between two marks of a ruler beside the roll's near rim")
        ->check(CLI::PositiveNumber)
        ->type_name("MM");
    verb.add_option("--known-length-at", options.known_length_at_px,
                    "Photo: the pixels of both ends of that length")
        ->delimiter(',')
        ->expected(4)
        ->type_name("X1,Y1,X2,Y2");
    verb.add_option("--box", arguments.box,
                    "Photo: look for the sheet only here, in pixels from the top left corner")
        ->delimiter(',')
        ->expected(4)
        ->type_name("LEFT,TOP,WIDTH,HEIGHT");
    verb.add_option("--seen-along-deg", options.seen_along_deg,
                    "Photo: direction of the layout that it looks along, the axis of the roll, from x on")
        ->type_name("DEG");
}

void add_compare(CLI::App& program, Action& action) {
    const auto arguments = std::make_shared<CompareArguments>();
    CLI::App* verb = program.add_subcommand(
        "compare", "Compare a result with a scan or a silhouette photo of what was made");
    verb->add_option("result", arguments->result, "Folder of a result")->required()->type_name("RESULT");
    verb->add_option(
            "made", arguments->made,
            "Scan of the made piece, also of a part of it (OBJ, PLY or STL), or a photo (PNG or JPEG) that "
            "looks along the axis of a rolled sheet")
        ->required()
        ->type_name("SCAN|PHOTO");
    verb->add_option("-o,--output", arguments->folder,
                     "Folder for compare.json and compare.html or silhouette.png; else RESULT")
        ->type_name("DIR");
    add_scan_options(*verb, arguments->options);
    add_photo_options(*verb, *arguments);
    verb->callback([arguments, verb, &action] {
        const auto given = [verb](std::initializer_list<const char*> names) {
            std::vector<std::string> found;
            for (const char* name : names)
                if (verb->count(name) > 0) found.emplace_back(name);
            return found;
        };
        arguments->of_scans = given({"--unit", "--skin", "--kept", "--free-scale"});
        arguments->of_photos = given({"--known-length-mm", "--known-length-at", "--box", "--seen-along-deg"});
        action = [arguments] { return run(*arguments); };
    });
}

}  // namespace ruche
