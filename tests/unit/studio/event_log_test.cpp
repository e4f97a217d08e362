#include "ruche/studio/event_log.hpp"

#include <doctest/doctest.h>

#include <thread>

using namespace ruche;
using namespace std::chrono_literals;

TEST_CASE("events: every reader gets what came after he began, in order, once") {
    EventLog log;
    log.publish("job", "0");
    long early = log.last();
    log.publish("job", "1");
    long late = log.last();
    log.publish("runs", "{}");
    CHECK(log.after(early, 0ms) == "event: job\ndata: 1\n\nevent: runs\ndata: {}\n\n");
    CHECK(log.after(late, 0ms) == "event: runs\ndata: {}\n\n");
    CHECK(log.after(late, 0ms).empty());
}

TEST_CASE("events: a waiting reader is woken by news and by the end") {
    EventLog log;
    long seen = log.last();
    std::thread writer([&] { log.publish("shape", "7"); });
    CHECK(log.after(seen, 10s) == "event: shape\ndata: 7\n\n");
    writer.join();
    std::thread closer([&] { log.close(); });
    // Not woken, it would wait until the test is stopped.
    CHECK(log.after(seen, 1h).empty());
    closer.join();
}

TEST_CASE("events: who falls far behind misses some, and goes on with the latest") {
    EventLog log;
    long seen = log.last();
    for (int i = 0; i < 1000; ++i) log.publish("shape", std::to_string(i));
    const std::string text = log.after(seen, 0ms);
    CHECK(text.find("data: 999\n") != std::string::npos);
    CHECK(text.find("data: 10\n") == std::string::npos);
    CHECK(text.size() < 10000);
}
