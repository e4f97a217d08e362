#include "ruche/studio/event_log.hpp"

namespace ruche {

void EventLog::publish(const std::string& type, const std::string& data) {
    constexpr std::size_t kept = 200;
    {
        const std::scoped_lock lock(mutex_);
        ++last_;
        events_.push_back({last_, "event: " + type + "\ndata: " + data + "\n\n"});
        if (events_.size() > kept) events_.pop_front();
    }
    news_.notify_all();
}

long EventLog::last() const {
    const std::scoped_lock lock(mutex_);
    return last_;
}

std::string EventLog::after(long& seen, std::chrono::milliseconds wait) {
    std::unique_lock lock(mutex_);
    news_.wait_for(lock, wait, [&] { return closed_ || last_ > seen; });
    std::string text;
    for (const Event& event : events_)
        if (event.number > seen) text += event.text;
    seen = last_;
    return text;
}

void EventLog::close() {
    {
        const std::scoped_lock lock(mutex_);
        closed_ = true;
    }
    news_.notify_all();
}

}  // namespace ruche
