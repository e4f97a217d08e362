#include "ruche/studio/job_queue.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "ruche/core/error.hpp"
#include "ruche/studio/error_json.hpp"

namespace ruche {

using Json = nlohmann::ordered_json;
using Clock = std::chrono::steady_clock;

struct JobQueue::Job {
    int id = 0;
    JobOrder order;
    std::string state = "waiting";  // waiting, running, done, failed, cancelled
    std::atomic<bool> stop = false;
    std::string phase;
    std::string text;
    std::string outcome;  // of a release: "converged", ...; of a comparison "compared"
    std::string error;    // JSON
    TimeLeft time_left;
    Clock::time_point begin;
    Clock::time_point last_told;
    double seconds = 0.0;

    bool waits() const { return state == "waiting"; }
    bool runs() const { return state == "running"; }
    bool is_preview() const { return order.kind == JobKind::preview; }
    const char* kind_name() const {
        return is_preview() ? "preview" : order.kind == JobKind::release ? "release" : "comparison";
    }

    Json json() const {
        Json json = {
            {"id", id},
            {"kind", kind_name()},
            {"owner", order.owner},
            {"state", state},
            {"folder", order.folder},
            {"phase", phase},
            {"text", text},
            {"outcome", outcome},
            {"seconds", runs() ? std::chrono::duration<double>(Clock::now() - begin).count() : seconds},
            {"share", time_left.share()},
            {"left_s", nullptr}};
        if (runs() && time_left.seconds() >= 0.0) json["left_s"] = time_left.seconds();
        if (!error.empty()) json["error"] = Json::parse(error);
        return json;
    }
};

JobQueue::JobQueue(Workspace& workspace, EventLog& log, LiveShape& live)
    : workspace_(workspace), log_(log), live_(live), worker_([this] { work(); }) {}

JobQueue::~JobQueue() {
    {
        const std::scoped_lock lock(mutex_);
        quit_ = true;
        for (const auto& job : jobs_) job->stop = true;
    }
    wake_.notify_all();
    worker_.join();
}

int JobQueue::add(JobOrder order) {
    constexpr std::ptrdiff_t most_waiting = 20;
    constexpr std::size_t kept = 60;
    const std::scoped_lock lock(mutex_);
    if (std::count_if(jobs_.begin(), jobs_.end(), [](const auto& job) { return job->waits(); }) >=
        most_waiting)
        throw InputError({}, "too many releases wait already", "Cancel some, or wait until they are done.");
    std::vector<std::string> taken;
    for (const auto& job : jobs_) {
        if (job->waits() || job->runs()) taken.push_back(job->order.folder);
        const bool replaced = order.kind != JobKind::preview ? job->runs() : job->order.owner == order.owner;
        if (!job->is_preview() || !replaced) continue;
        job->stop = true;
        if (job->waits()) change(*job, "cancelled");
    }
    if (order.kind == JobKind::release) order.folder = workspace_.new_result(order.folder, taken);
    jobs_.push_back(std::make_unique<Job>());
    jobs_.back()->id = ++last_id_;
    jobs_.back()->order = std::move(order);
    if (jobs_.size() > kept && !jobs_.front()->waits() && !jobs_.front()->runs()) jobs_.pop_front();
    tell(*jobs_.back());
    wake_.notify_all();
    return last_id_;
}

void JobQueue::cancel(int id) {
    const std::scoped_lock lock(mutex_);
    for (const auto& job : jobs_) {
        if (job->id != id) continue;
        job->stop = true;
        if (job->waits()) change(*job, "cancelled");
    }
}

std::string JobQueue::json() const {
    const std::scoped_lock lock(mutex_);
    Json list = Json::array();
    for (auto job = jobs_.rbegin(); job != jobs_.rend(); ++job) list.push_back((*job)->json());
    return list.dump(-1, ' ', false, Json::error_handler_t::replace);
}

// The following are called with the mutex held.

void JobQueue::change(Job& job, const char* state) {
    job.state = state;
    tell(job);
}

void JobQueue::tell(const Job& job) {
    log_.publish("job", job.json().dump(-1, ' ', false, Json::error_handler_t::replace));
}

/// Previews after all else.
JobQueue::Job* JobQueue::next() {
    for (const bool preview : {false, true})
        for (const auto& job : jobs_)
            if (job->waits() && job->is_preview() == preview) return job.get();
    return nullptr;
}

// The worker's.

void JobQueue::work() {
    for (;;) {
        Job* job = nullptr;
        {
            std::unique_lock lock(mutex_);
            wake_.wait(lock, [&] { return quit_ || next() != nullptr; });
            if (quit_) return;
            job = next();
            job->begin = Clock::now();
            change(*job, "running");
        }
        run(*job);  // stays in the list while it runs
    }
}

Control JobQueue::control_of(Job& job) {
    Control control{.stop = &job.stop};
    control.report = [this, &job](const Progress& progress) {
        constexpr auto pause = std::chrono::milliseconds(120);
        const std::scoped_lock lock(mutex_);
        const bool new_phase = job.phase != progress.phase;
        job.phase = progress.phase;
        job.text = progress.text;
        if (!new_phase && Clock::now() - job.last_told < pause) return;
        job.last_told = Clock::now();
        tell(job);
    };
    control.watch = [this, &job](const Iterate& iterate) {
        live_.take(job.id, iterate);
        {
            const std::scoped_lock lock(mutex_);
            job.time_left.step(iterate.sheet.mesh.triangle_count(), iterate.iteration, Clock::now());
        }
        log_.publish("shape", std::to_string(live_.version()));
    };
    return control;
}

void JobQueue::run(Job& job) {
    std::string outcome;
    std::string error;
    try {
        switch (job.order.kind) {
            case JobKind::preview:
                run_preview(job.order, control_of(job));
                break;
            case JobKind::release:
                outcome = run_release(job.order, workspace_, control_of(job));
                break;
            case JobKind::comparison:
                run_comparison(job.order, workspace_, control_of(job));
                outcome = "compared";
                break;
        }
    } catch (...) {
        error = current_error_json();
    }
    {
        const std::scoped_lock lock(mutex_);
        job.seconds = std::chrono::duration<double>(Clock::now() - job.begin).count();
        job.outcome = outcome;
        job.error = error;
        job.order.scene = {};
        const bool cut_short = job.is_preview() ? job.stop.load() : outcome == "interrupted";
        change(job, !error.empty() ? "failed" : cut_short ? "cancelled" : "done");
    }
    if (!outcome.empty()) log_.publish("runs", "{}");
}

}  // namespace ruche
