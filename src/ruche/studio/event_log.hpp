#pragma once

#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <string>

namespace ruche {

/// What has happened, for any number of readers who each wait for news: server-sent events. A reader who
/// falls behind misses some; what he needs to know he can ask for.
class EventLog {
  public:
    /// `data` is one line.
    void publish(const std::string& type, const std::string& data);

    /// The number of the last event, from which a new reader reads on.
    long last() const;

    /// The events after number `seen`, as they are sent; waits for one at most so long. Moves `seen` on.
    std::string after(long& seen, std::chrono::milliseconds wait);

    /// Wakes every reader, for good.
    void close();

  private:
    struct Event {
        long number;
        std::string text;
    };
    mutable std::mutex mutex_;
    std::condition_variable news_;
    std::deque<Event> events_;
    long last_ = 0;
    bool closed_ = false;
};

}  // namespace ruche
