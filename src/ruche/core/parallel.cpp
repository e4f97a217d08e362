#include "ruche/core/parallel.hpp"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <exception>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

namespace ruche {
namespace {

thread_local bool inside_parallel_for = false;

/// Threads that sleep between jobs (they never spin: on a busy machine spinning threads cost more than they
/// bring).
class Pool {
  public:
    explicit Pool(int workers) {
        for (int i = 0; i < workers; ++i) threads_.emplace_back([this, worker = i + 1] { work(worker); });
    }
    Pool(const Pool&) = delete;
    Pool& operator=(const Pool&) = delete;
    ~Pool() {
        {
            const std::scoped_lock lock(mutex_);
            quit_ = true;
        }
        wake_.notify_all();
        for (std::thread& thread : threads_) thread.join();
    }

    int size() const { return static_cast<int>(threads_.size()) + 1; }

    void run(std::size_t count, const std::function<void(std::size_t, int)>& body) {
        {
            const std::scoped_lock lock(mutex_);
            body_ = &body;
            count_ = count;
            next_.store(0);
            error_ = nullptr;
            busy_ = static_cast<int>(threads_.size());
            ++job_;
        }
        wake_.notify_all();
        take_items(0);
        std::unique_lock lock(mutex_);
        done_.wait(lock, [this] { return busy_ == 0; });
        body_ = nullptr;
        if (error_) std::rethrow_exception(error_);
    }

  private:
    void take_items(int worker) {
        inside_parallel_for = true;
        for (std::size_t i = next_.fetch_add(1); i < count_; i = next_.fetch_add(1)) {
            try {
                (*body_)(i, worker);
            } catch (...) {
                const std::scoped_lock lock(mutex_);
                if (!error_) error_ = std::current_exception();
                next_.store(count_);
            }
        }
        inside_parallel_for = false;
    }

    void work(int worker) {
        std::size_t seen = 0;
        for (;;) {
            {
                std::unique_lock lock(mutex_);
                wake_.wait(lock, [&] { return quit_ || job_ != seen; });
                if (quit_) return;
                seen = job_;
            }
            take_items(worker);
            {
                const std::scoped_lock lock(mutex_);
                --busy_;
            }
            done_.notify_one();
        }
    }

    std::vector<std::thread> threads_;
    std::mutex mutex_;
    std::condition_variable wake_;
    std::condition_variable done_;
    std::size_t job_ = 0;
    int busy_ = 0;
    bool quit_ = false;
    const std::function<void(std::size_t, int)>* body_ = nullptr;
    std::size_t count_ = 0;
    std::atomic<std::size_t> next_{0};
    std::exception_ptr error_;
};

std::mutex pool_mutex;
std::atomic<int> wanted_threads = 0;

int machine_threads() { return std::max(1, static_cast<int>(std::thread::hardware_concurrency())); }

Pool& pool() {
    static std::unique_ptr<Pool> instance;
    const int wanted = thread_count();
    if (!instance || instance->size() != wanted) instance = std::make_unique<Pool>(wanted - 1);
    return *instance;
}

}  // namespace

int thread_count() {
    const int wanted = wanted_threads;
    return wanted > 0 ? wanted : machine_threads();
}

void set_thread_count(int count) {
    const std::scoped_lock lock(pool_mutex);
    wanted_threads = std::max(1, count);
}

void parallel_for_workers(std::size_t count, const std::function<void(std::size_t, int)>& body) {
    if (inside_parallel_for || count <= 1 || thread_count() == 1) {
        for (std::size_t i = 0; i < count; ++i) body(i, 0);
        return;
    }
    const std::scoped_lock one_job_at_a_time(pool_mutex);
    pool().run(count, body);
}

void parallel_for(std::size_t count, const std::function<void(std::size_t)>& body) {
    parallel_for_workers(count, [&](std::size_t i, int) { body(i); });
}

}  // namespace ruche
