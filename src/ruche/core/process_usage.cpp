#include "ruche/core/process_usage.hpp"

#include <sys/resource.h>

#include <ctime>

namespace ruche {

double processor_seconds() {
    timespec time{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

double peak_megabytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    constexpr double unit = 1024e-6;  // Linux counts in KiB
    return unit * static_cast<double>(usage.ru_maxrss);
}

}  // namespace ruche
