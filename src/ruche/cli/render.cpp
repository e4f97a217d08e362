#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <filesystem>
#include <map>
#include <memory>

#include "ruche/cli/interrupt.hpp"
#include "ruche/cli/progress_display.hpp"
#include "ruche/cli/verbs.hpp"
#include "ruche/core/atomic_file.hpp"
#include "ruche/core/error.hpp"
#include "ruche/output/animation.hpp"
#include "ruche/output/portrait.hpp"
#include "ruche/scene/read_result.hpp"

namespace ruche {
namespace {

struct RenderArguments {
    std::string folder;
    std::string output;
    std::string view;
    PortraitOptions portrait;
    double elevation_deg = NAN;
    bool turntable = false;
    bool release = false;
    int frames = 0;  ///< 0 = as many as are usual for the kind
    double seconds = 6.0;
};

/// Directions with a name: the viewer's azimuth and elevation, degrees.
const std::map<std::string, std::pair<double, double>> views = {{"front", {0, 0}},  {"right", {90, 0}},
                                                                {"back", {180, 0}}, {"left", {270, 0}},
                                                                {"top", {0, 89.9}}, {"bottom", {0, -89.9}}};

bool is_animation(const RenderArguments& arguments) { return arguments.turntable || arguments.release; }

std::string output_path(const RenderArguments& arguments) {
    if (!arguments.output.empty()) {
        const std::string ending = std::filesystem::path(arguments.output).extension();
        const bool webp = is_animation(arguments) && ending == ".webp";
        if (!webp && ending != ".png" && !(is_animation(arguments) && ending == ".apng"))
            throw InputError({.key = "-o " + arguments.output},
                             is_animation(arguments) ? "ends neither in .webp nor in .png or .apng"
                                                     : "has another ending than .png",
                             "Pictures are PNG files, films (--turntable, --release) WebP or animated PNG.");
        return arguments.output;
    }
    const char* name = arguments.turntable ? "turntable.webp"
                       : arguments.release ? "release.webp"
                                           : "render.png";
    return (std::filesystem::path(arguments.folder) / name).string();
}

Animation film_of(const RenderArguments& arguments) {
    const bool webp = std::filesystem::path(output_path(arguments)).extension() == ".webp";
    return {webp ? AnimationKind::webp : AnimationKind::png, arguments.portrait.width_px,
            arguments.portrait.height_px};
}

PortraitOptions portrait_options(const RenderArguments& arguments) {
    PortraitOptions options = arguments.portrait;
    if (!arguments.view.empty()) {
        const auto& [azimuth, elevation] = views.at(arguments.view);
        options.azimuth_deg += azimuth;
        options.elevation_deg = elevation;
    }
    if (std::isfinite(arguments.elevation_deg)) options.elevation_deg = arguments.elevation_deg;
    return options;
}

void must_go_on() {
    if (interrupted()) throw std::runtime_error("interrupted: nothing was written");
}

std::string turntable(const Result& result, const RenderArguments& arguments, ProgressDisplay& display) {
    const PortraitOptions options = portrait_options(arguments);
    const Portrait portrait(result, options);
    Animation film = film_of(arguments);
    const int frames = arguments.frames > 0 ? arguments.frames : 60;
    for (int i = 0; i < frames; ++i) {
        must_go_on();
        display.show(
            {"render", static_cast<double>(i) / frames, fmt::format("picture {} of {}", i + 1, frames)});
        film.add(portrait.released(360.0 * i / frames),
                 static_cast<int>(1000.0 * arguments.seconds / frames));
    }
    return film.file();
}

/// Forth: every frame of the release, and the final shape for as long as the way to it.
std::string release_film(Result& result, const RenderArguments& arguments, ProgressDisplay& display) {
    result.scene.output.film_frames = arguments.frames > 0 ? arguments.frames : 36;
    const Control control{.report = [&](const Progress& progress) { display.show(progress); },
                          .stop = &interrupted()};
    const std::optional<ReleaseFilm> way = film_release(result, control);
    must_go_on();
    if (!way)
        throw InputError(
            {.file = arguments.folder}, "cannot be followed back to the flat state",
            "A film needs a converged shape on a drawing, or a mesh of at most 15000 triangles.");
    const PortraitOptions options = portrait_options(arguments);
    const Portrait portrait(result, options, way->frames);
    Animation film = film_of(arguments);
    const std::size_t count = way->frames.size();
    const double each_ms = 500.0 * arguments.seconds / static_cast<double>(count);
    for (std::size_t i = 0; i < count; ++i) {
        must_go_on();
        display.show({"render", static_cast<double>(i) / static_cast<double>(count),
                      fmt::format("picture {} of {}", i + 1, count + 1)});
        film.add(portrait.other(way->layout, way->frames[i].shape),
                 static_cast<int>(i == 0 ? 600.0 : each_ms));
    }
    film.add(portrait.released(), static_cast<int>(500.0 * arguments.seconds));
    return film.file();
}

ExitCode run(const RenderArguments& arguments) {
    const std::string path = output_path(arguments);
    Result result = read_result(arguments.folder);
    watch_for_interrupts();
    ProgressDisplay display;
    std::string contents;
    if (arguments.turntable)
        contents = turntable(result, arguments, display);
    else if (arguments.release)
        contents = release_film(result, arguments, display);
    else
        contents = to_png(Portrait(result, portrait_options(arguments)).released());
    write_file_atomically(path, contents);
    display.clear();
    fmt::print("{}\n", path);
    return ExitCode::converged;
}

}  // namespace

void add_render(CLI::App& program, Action& action) {
    const auto arguments = std::make_shared<RenderArguments>();
    CLI::App* verb =
        program.add_subcommand("render", "Take pictures and films of a result, without a display");
    verb->add_option("result", arguments->folder, "Folder that `ruche simulate` has written")
        ->required()
        ->type_name("RESULT");
    verb->add_option(
            "-o,--output", arguments->output,
            "File to write: .png; for films .webp, or .png and .apng, which are larger and exact; else "
            "RESULT/render.png, turntable.webp, release.webp")
        ->type_name("FILE");
    PortraitOptions& portrait = arguments->portrait;
    portrait.width_px = 1200;
    portrait.height_px = 900;
    verb->add_option("--width-px", portrait.width_px, "Width of the picture")->check(CLI::Range(64, 16384));
    verb->add_option("--height-px", portrait.height_px, "Height of the picture")
        ->check(CLI::Range(64, 16384));
    std::vector<std::string> names;
    names.reserve(views.size());
    for (const auto& [name, direction] : views) names.push_back(name);
    verb->add_option("--view", arguments->view, "Look from there; else from where most can be seen")
        ->check(CLI::IsMember(names));
    verb->add_option("--azimuth-deg", portrait.azimuth_deg, "Walk around the shape by so much")
        ->type_name("DEG");
    verb->add_option("--elevation-deg", arguments->elevation_deg, "Look down from so far above the horizon")
        ->type_name("DEG")
        ->check(CLI::Range(-89.9, 89.9))
        ->default_str("");
    std::string fields;
    for (const std::string& name : colour_field_names()) fields += (fields.empty() ? "" : ", ") + name;
    verb->add_option("--colour", portrait.colour,
                     "Colour by " + fields + "; else fabric and plastic as they are")
        ->type_name("FIELD");
    verb->add_flag("--transparent", portrait.transparent, "Nothing behind the sheet but its shadow");
    CLI::Option* turntable =
        verb->add_flag("--turntable", arguments->turntable, "Film: once around the shape");
    verb->add_flag("--release", arguments->release,
                   "Film: from flat to released, through equilibria at growing pre-stretch")
        ->excludes(turntable);
    verb->add_option("--frames", arguments->frames, "Pictures of a film; else 60 or 36")
        ->check(CLI::Range(2, 1000));
    verb->add_option("--seconds", arguments->seconds, "Length of a film")->check(CLI::Range(0.5, 600.0));
    verb->callback([arguments, &action] { action = [arguments] { return run(*arguments); }; });
}

}  // namespace ruche
