#include "ruche/studio/studio.hpp"

#include <fmt/format.h>

#include <charconv>
#include <nlohmann/json.hpp>
#include <thread>

#include "ruche/core/document.hpp"
#include "ruche/core/error.hpp"
#include "ruche/output/packed_arrays.hpp"
#include "ruche/output/page_template.hpp"
#include "ruche/studio/error_json.hpp"
#include "ruche/studio/http_server.hpp"
#include "ruche/studio/job_queue.hpp"
#include "ruche/studio/scene_request.hpp"
#include "ruche/studio/shape_difference.hpp"

namespace ruche {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

HttpReply error_reply(int status, const std::string& error) {
    return {.status = status, .body = "{\"error\": " + error + "}"};
}

HttpReply not_found() { return error_reply(404, R"({"message": "there is nothing at this address"})"); }

const char* type_of(const fs::path& file) {
    const std::string ending = file.extension().string();
    if (ending == ".html") return "text/html; charset=utf-8";
    if (ending == ".json") return "application/json";
    if (ending == ".svg") return "image/svg+xml";
    if (ending == ".png") return "image/png";
    if (ending == ".glb") return "model/gltf-binary";
    return ending == ".toml" || ending == ".mtl" ? "text/plain; charset=utf-8" : "application/octet-stream";
}

class Studio {
  public:
    explicit Studio(const std::string& folder) : workspace_(folder), queue_(workspace_, log_, live_) {}

    HttpReply answer(const HttpRequest& request) {
        try {
            return request.method == "POST" ? take(request) : give(request);
        } catch (const OutsideFolder&) {
            return error_reply(403, current_error_json());
        } catch (...) {
            return error_reply(is_input_error() ? 422 : 500, current_error_json());
        }
    }

    HttpStream events() {
        return [this, seen = log_.last()](std::string& out) mutable {
            constexpr auto patience = std::chrono::milliseconds(1000);
            out = log_.after(seen, patience);
            return true;
        };
    }

    /// Tells the pages when a run of the command line has changed the folder's results.
    void look_for_runs() {
        std::string list;
        for (const RunEntry& run : workspace_.runs()) list += fmt::format("{} {}\n", run.folder, run.written);
        if (std::exchange(runs_, list) != list) log_.publish("runs", "{}");
    }

    void close() { log_.close(); }

  private:
    HttpReply give(const HttpRequest& request) {
        if (request.path == "/")
            return {.type = "text/html; charset=utf-8", .body = std::string(studio_page()), .page = true};
        if (request.path == "/api/form") return {.body = form_json(workspace_)};
        if (request.path == "/api/jobs") return {.body = queue_.json()};
        if (request.path == "/api/runs") return {.body = runs_json()};
        if (request.path == "/api/shape") return {.body = live_.json(number(request, "mesh"))};
        if (request.path == "/api/difference")
            return {.body = shape_difference(state_path(request, "a"), state_path(request, "b"))};
        constexpr std::string_view files = "/files/";
        if (request.path.starts_with(files)) return file(request.path.substr(files.size()), request);
        return not_found();
    }

    HttpReply take(const HttpRequest& request) {
        if (request.path == "/api/drawing") {
            const std::scoped_lock one_at_a_time(drawing_mutex_);
            return {.body = drawing_json(scene_from_request(request.body, workspace_))};
        }
        if (request.path == "/api/upload") return upload(request);
        if (request.path == "/api/release") return start(request, JobKind::release);
        if (request.path == "/api/preview") return start(request, JobKind::preview);
        if (request.path == "/api/compare") return compare(request);
        if (request.path == "/api/cancel") {
            queue_.cancel(Json::parse(request.body).at("id").get<int>());
            return {.body = "{}"};
        }
        return not_found();
    }

    static int number(const HttpRequest& request, const std::string& key) {
        const auto found = request.query.find(key);
        int value = 0;
        if (found != request.query.end())
            std::from_chars(found->second.data(), found->second.data() + found->second.size(), value);
        return value;
    }

    HttpReply upload(const HttpRequest& request) {
        const Json given = Json::parse(request.body);
        const std::string name =
            workspace_.keep_drawing(given.at("name").get<std::string>(), given.at("text").get<std::string>());
        return {.body = Json{{"name", name}}.dump()};
    }

    HttpReply start(const HttpRequest& request, JobKind kind) {
        const Json given = Json::parse(request.body);
        JobOrder order{.kind = kind,
                       .owner = given.value("owner", ""),
                       .scene = scene_from_request(request.body, workspace_),
                       .folder = {},
                       .start = given.value("start", "")};
        if (!order.start.empty()) (void)workspace_.inside(order.start);
        if (kind == JobKind::release) order.folder = scene_name(order.scene);
        return {.body = Json{{"id", queue_.add(std::move(order))}}.dump()};
    }

    /// {"run": "torus.out", "made": "scan.stl", "unit": ""}; a photo has "photo": {"known_length_mm": 50,
    /// "known_length_at_px": [x, y, x, y], "seen_along_deg": 90} instead of a unit. With "bytes", in base64,
    /// the file is written first.
    HttpReply compare(const HttpRequest& request) {
        const Json given = Json::parse(request.body);
        JobOrder order{.kind = JobKind::comparison,
                       .owner = given.value("owner", ""),
                       .folder = given.at("run").get<std::string>(),
                       .made = given.at("made").get<std::string>(),
                       .unit = given.value("unit", "")};
        if (given.contains("photo")) {
            const Json& photo = given.at("photo");
            order.photo = SilhouetteOptions{
                .known_length_mm = photo.at("known_length_mm").get<double>(),
                .known_length_at_px = photo.at("known_length_at_px").get<std::vector<double>>(),
                .box = {},
                .seen_along_deg = photo.value("seen_along_deg", 90.0)};
        }
        if (!fs::exists(workspace_.inside(order.folder + "/report.json")))
            throw InputError({}, "there is no result " + order.folder, "Choose one of the list.");
        (void)scene_from_request(scene_of(order.folder), workspace_);  // its files lie in the folder, too
        if (given.contains("bytes"))
            order.made =
                workspace_.keep_measured(order.made, from_base64(given.at("bytes").get<std::string>()));
        else
            (void)workspace_.inside(order.made);
        const std::string made = order.made;
        return {.body = Json{{"id", queue_.add(std::move(order))}, {"made", made}}.dump()};
    }

    std::string runs_json() {
        Json list = Json::array();
        for (const RunEntry& run : workspace_.runs())
            list.push_back({{"folder", run.folder},
                            {"written", run.written},
                            {"page", run.page},
                            {"compared", run.compared},
                            {"photographed", run.photographed},
                            {"summary", Json::parse(run.summary)}});
        return list.dump(-1, ' ', false, Json::error_handler_t::replace);
    }

    std::string state_path(const HttpRequest& request, const std::string& key) const {
        const auto run = request.query.find(key);
        return workspace_.inside((run == request.query.end() ? "" : run->second) + "/state.ruche").string();
    }

    static std::string scene_of(const fs::path& run) {
        return Json{{"base", {{"scene", (run / "scene.toml").string()}}}}.dump();
    }

    /// The drawing that a result was made from, which lies elsewhere or in the generator.
    HttpReply drawing_of(const fs::path& run) const {
        return {.type = "image/svg+xml",
                .body = drawing_svg(scene_from_request(scene_of(run), workspace_)),
                .download = run.stem().string() + ".svg"};
    }

    HttpReply file(const std::string& relative, const HttpRequest& request) const {
        const fs::path given(relative);
        if (given.filename() == "drawing.svg" &&
            !workspace_.served_file((given.parent_path() / "report.json").string()).empty())
            return drawing_of(given.parent_path());
        const fs::path path = workspace_.served_file(relative);
        if (path.empty()) return not_found();
        constexpr std::size_t longest = std::size_t{1} << 30U;
        HttpReply reply{.type = type_of(path), .body = read_file(path.string(), "file", longest)};
        const bool shown =
            path.extension() == ".html" || path.extension() == ".png" || path.extension() == ".json";
        reply.foreign = path.extension() == ".html";
        if (!shown || request.query.contains("download"))
            reply.download = path.parent_path() == workspace_.root()
                                 ? path.filename().string()
                                 : path.parent_path().stem().string() + "-" + path.filename().string();
        std::erase_if(reply.download,
                      [](char c) { return c == '"' || c == '\\' || static_cast<unsigned char>(c) < 32; });
        return reply;
    }

    Workspace workspace_;
    EventLog log_;
    LiveShape live_;
    std::mutex drawing_mutex_;
    std::string runs_;
    JobQueue queue_;
};

}  // namespace

bool can_open_studio() { return !studio_page().empty(); }

void run_studio(const StudioOptions& options, const std::atomic<bool>& stop,
                const std::function<void(const std::string& address)>& ready) {
    Studio studio(options.folder);
    HttpServer server({.answer = [&](const HttpRequest& request) { return studio.answer(request); },
                       .events = [&] { return studio.events(); }});
    const int port = server.bind(options.port);
    std::thread serving([&] { server.serve(); });
    ready(fmt::format("http://127.0.0.1:{}/", port));
    constexpr auto tick = std::chrono::milliseconds(100);
    constexpr int ticks_between_looks = 20;
    for (int i = 0; !stop; ++i) {
        if (i % ticks_between_looks == 0) studio.look_for_runs();
        std::this_thread::sleep_for(tick);
    }
    studio.close();
    server.stop();
    serving.join();
}

}  // namespace ruche
