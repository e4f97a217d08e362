#include "ruche/studio/http_server.hpp"

#include <fmt/format.h>
#include <httplib.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <span>
#include <stdexcept>

namespace ruche {
namespace {

constexpr const char* loopback = "127.0.0.1";
constexpr std::size_t longest_path = 1000;
constexpr std::size_t largest_body = 24U << 20U;
constexpr std::size_t small_body = 256U << 10U;
constexpr auto body_time = std::chrono::seconds(20);
constexpr int silence_s = 5;
constexpr int most_streams = 32;
constexpr std::size_t threads = 64;  // a stream keeps one, a slow client another
constexpr const char* events_path = "/api/events";

constexpr const char* no_content = "default-src 'none'; frame-ancestors 'none'";
constexpr const char* page_content =
    "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src 'self' data: blob:; "
    "connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";
constexpr const char* foreign_content =
    "sandbox allow-scripts allow-downloads allow-modals; default-src 'none'; script-src 'unsafe-inline'; "
    "style-src 'unsafe-inline'; img-src data: blob:; frame-ancestors 'none'";

void refuse(httplib::Response& response, int status, const std::string& why) {
    response.status = status;
    response.set_content(fmt::format("{{\"error\": {{\"message\": \"{}\"}}}}", why), "application/json");
}

/// A header that has to be there exactly once.
bool is_one_of(const httplib::Request& request, const char* header, std::span<const std::string> allowed) {
    return request.get_header_value_count(header) == 1 &&
           std::find(allowed.begin(), allowed.end(), request.get_header_value(header)) != allowed.end();
}

/// As it is: the library would pack it with Brotli, for seconds, to send it to the same machine.
void set_unpacked(httplib::Response& response, const std::string& body, const std::string& type) {
    if (body.empty()) return response.set_content(body, type);
    response.set_content_provider(body.size(), type,
                                  [kept = body](std::size_t at, std::size_t size, httplib::DataSink& sink) {
                                      return sink.write(kept.data() + at, size);
                                  });
}

void send(httplib::Response& response, const HttpReply& reply) {
    if (reply.status != 200)
        response.status = reply.status;  // else the library says 206 where a part was wanted
    set_unpacked(response, reply.body, reply.type);
    response.set_header("Content-Security-Policy", reply.page      ? page_content
                                                   : reply.foreign ? foreign_content
                                                                   : no_content);
    if (!reply.download.empty())
        response.set_header("Content-Disposition", "attachment; filename=\"" + reply.download + "\"");
}

}  // namespace

struct HttpServer::Parts {
    explicit Parts(HttpHandlers given) : handlers(std::move(given)) {}

    HttpHandlers handlers;
    httplib::Server server;
    std::array<std::string, 2> hosts;    // as a browser names this server
    std::array<std::string, 2> origins;  // its pages
    std::atomic<int> streams = 0;
    std::atomic<bool> closing = false;

    /// Whether the request may come in at all; else it is answered.
    bool admit(const httplib::Request& request, httplib::Response& response) const {
        const bool known_method =
            request.method == "GET" || request.method == "HEAD" || request.method == "POST";
        const bool own_origin = !request.has_header("Origin") || is_one_of(request, "Origin", origins);
        const std::string site = request.get_header_value("Sec-Fetch-Site");
        if (!is_one_of(request, "Host", hosts))
            refuse(response, 421, "this server answers only to its own address");
        else if (!own_origin || site == "cross-site" || site == "same-site")
            refuse(response, 403, "another site's page may not use this server");
        else if (!known_method)
            refuse(response, 405, "only GET and POST are understood");
        else if (request.target.size() > longest_path)
            refuse(response, 414, "the address is too long");
        else if (request.method == "POST" && request.get_header_value("Content-Type") != "application/json")
            refuse(response, 415, "only application/json is taken");
        else
            return true;
        return false;
    }

    HttpReply answer(const httplib::Request& request, std::string body) const {
        HttpRequest plain{.method = request.method == "POST" ? "POST" : "GET",
                          .path = request.path,
                          .query = {},
                          .body = std::move(body)};
        for (const auto& [key, value] : request.params) plain.query[key] = value;
        return handlers.answer(plain);
    }

    void take_post(const httplib::Request& request, httplib::Response& response,
                   const httplib::ContentReader& read) {
        const auto late = std::chrono::steady_clock::now() + body_time;
        std::string body;
        const auto take = [&](std::size_t most) {
            return !request.is_multipart_form_data() && read([&](const char* data, std::size_t size) {
                if (body.size() + size > most || std::chrono::steady_clock::now() > late) return false;
                body.append(data, size);
                return true;
            });
        };
        if (!admit(request, response)) {
            (void)take(small_body);  // closing on what is not read would take the answer away from the client
            (void)admit(request, response);
            return;
        }
        if (!take(largest_body))
            return refuse(response, 413,
                          fmt::format("the request is not complete: at most {} MB in {} s are taken",
                                      largest_body >> 20U, body_time.count()));
        send(response, answer(request, std::move(body)));
    }

    void open_stream(httplib::Response& response) {
        if (streams.fetch_add(1) >= most_streams) {
            --streams;
            return refuse(response, 503, "too many pages listen already");
        }
        response.set_header("Content-Security-Policy", no_content);
        response.set_chunked_content_provider(
            "text/event-stream",
            [this, next = handlers.events()](std::size_t, httplib::DataSink& sink) {
                std::string text;
                const bool more = !closing && next(text);
                if (text.empty()) text = ": still here\n\n";  // finds out whether anyone listens
                if (!sink.write(text.data(), text.size())) return false;
                if (!more) sink.done();
                return true;
            },
            [this](bool) { --streams; });
    }

    void set_up() {
        server.new_task_queue = [] { return new httplib::ThreadPool(threads); };
        server.set_socket_options([](int socket) {
            const int yes =
                1;  // a port that was in use a moment ago may be taken, one that is in use may not
            setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes));
        });
        server.set_keep_alive_max_count(1);
        server.set_read_timeout(silence_s);
        server.set_write_timeout(silence_s);
        server.set_payload_max_length(largest_body);
        server.set_tcp_nodelay(true);
        server.set_default_headers({{"X-Content-Type-Options", "nosniff"},
                                    {"Referrer-Policy", "no-referrer"},
                                    {"Cross-Origin-Resource-Policy", "same-origin"},
                                    {"Cache-Control", "no-store"}});
        server.set_pre_routing_handler([this](const httplib::Request& request, httplib::Response& response) {
            using Response = httplib::Server::HandlerResponse;
            if (request.method == "POST" && request.target.size() <= longest_path) return Response::Unhandled;
            if (!admit(request, response)) return Response::Handled;
            if (request.path == events_path && request.method == "GET")
                open_stream(response);
            else
                send(response, answer(request, {}));
            return Response::Handled;
        });
        server.Post(".*", [this](const httplib::Request& request, httplib::Response& response,
                                 const httplib::ContentReader& read) { take_post(request, response, read); });
        server.set_exception_handler(
            [](const httplib::Request&, httplib::Response& response, const std::exception_ptr&) {
                refuse(response, 500, "the server failed to answer this");
            });
    }
};

HttpServer::HttpServer(HttpHandlers handlers) : parts_(std::make_unique<Parts>(std::move(handlers))) {
    parts_->set_up();
}

HttpServer::~HttpServer() = default;

int HttpServer::bind(int port) {
    const int bound = port == 0 ? parts_->server.bind_to_any_port(loopback)
                      : parts_->server.bind_to_port(loopback, port) ? port
                                                                    : -1;
    if (bound <= 0) throw std::runtime_error(fmt::format("port {} of this machine is in use", port));
    parts_->hosts = {fmt::format("{}:{}", loopback, bound), fmt::format("localhost:{}", bound)};
    parts_->origins = {"http://" + parts_->hosts[0], "http://" + parts_->hosts[1]};
    return bound;
}

void HttpServer::serve() { parts_->server.listen_after_bind(); }

void HttpServer::stop() {
    parts_->closing = true;
    parts_->server.stop();
}

}  // namespace ruche
