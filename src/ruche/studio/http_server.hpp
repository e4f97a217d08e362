#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>

namespace ruche {

struct HttpRequest {
    std::string method;  ///< "GET" or "POST"
    std::string path;    ///< decoded: "/files/torus.out/report.html"
    std::map<std::string, std::string> query;
    std::string body;
};

struct HttpReply {
    int status = 200;
    std::string type = "application/json";
    std::string body;
    std::string download = {};  ///< the name to be saved under; empty: it is shown
    bool page = false;          ///< the studio's own page, whose scripts may run and ask the server
    bool foreign = false;       ///< a page that may run its scripts, but is kept from the server
};

/// Appends text to send to `out`, waiting up to a second or so for some; false ends the stream.
using HttpStream = std::function<bool(std::string& out)>;

struct HttpHandlers {
    std::function<HttpReply(const HttpRequest&)> answer;
    std::function<HttpStream()> events;  ///< a new reader of /api/events
};

/// A server for one person at one machine. It listens on the loopback address only and refuses, before
/// anything else is looked at, requests whose Host is not its own (a foreign name that leads here), whose
/// Origin is another page's, and posts that are not JSON; so no page of another site can make a browser use
/// it. Every connection carries one request, so that what is left of a refused one is never read as another.
/// Limits: 1000 bytes of path, 24 MB of body, 20 s to send it, 5 s without a byte, 32 streams of events.
class HttpServer {
  public:
    explicit HttpServer(HttpHandlers handlers);
    ~HttpServer();
    HttpServer(const HttpServer&) = delete;
    HttpServer& operator=(const HttpServer&) = delete;

    /// Takes a port, 0 for any free one; returns it. Throws std::runtime_error when it is in use.
    int bind(int port);
    /// Serves until `stop`, which may be called from another thread.
    void serve();
    void stop();

  private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace ruche
