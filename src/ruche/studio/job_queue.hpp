#pragma once

#include <condition_variable>
#include <deque>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "ruche/studio/event_log.hpp"
#include "ruche/studio/job.hpp"
#include "ruche/studio/live_shape.hpp"
#include "ruche/studio/workspace.hpp"

namespace ruche {

/// One queue for all pages, one job at a time: a release takes every core by itself. Tells of its jobs by the
/// events "job" (one job's state), "shape" (a new live shape) and "runs" (a result was written).
class JobQueue {
  public:
    JobQueue(Workspace& workspace, EventLog& log, LiveShape& live);
    /// Stops what runs; a release writes how far it got.
    ~JobQueue();
    JobQueue(const JobQueue&) = delete;
    JobQueue& operator=(const JobQueue&) = delete;

    /// Returns the job's number. A preview takes the place of its owner's earlier one, and waits while there
    /// are others to do. A release gets a folder of its own (`order.folder` is its name). What is no preview
    /// stops running ones. Throws InputError when too many wait.
    int add(JobOrder order);

    /// Stops a running job at its next step, takes a waiting one away.
    void cancel(int id);

    /// All jobs of which a page may want to know, as a JSON array, latest first.
    std::string json() const;

  private:
    struct Job;
    void work();
    void run(Job& job);
    void change(Job& job, const char* state);
    void tell(const Job& job);
    Control control_of(Job& job);
    Job* next();

    Workspace& workspace_;
    EventLog& log_;
    LiveShape& live_;
    mutable std::mutex mutex_;
    std::condition_variable wake_;
    std::deque<std::unique_ptr<Job>> jobs_;  // in the order in which they came
    int last_id_ = 0;
    bool quit_ = false;
    std::thread worker_;
};

}  // namespace ruche
