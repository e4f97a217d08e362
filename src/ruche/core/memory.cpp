#include "ruche/core/memory.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <string>

namespace ruche {
namespace {

constexpr std::size_t unlimited = std::numeric_limits<std::size_t>::max();

/// The number after `key` in a file of "key: number kB" lines, in bytes; `otherwise` when it is not there.
std::size_t kilobytes(const char* path, const std::string& key, std::size_t otherwise) {
    std::ifstream file(path);
    for (std::string line; std::getline(file, line);) {
        if (line.starts_with(key)) return std::stoull(line.substr(key.size())) << 10U;
    }
    return otherwise;
}

/// A file that holds one number; "max" and a missing file have none.
std::size_t number(const char* path) {
    std::ifstream file(path);
    std::size_t value = 0;
    return file >> value ? value : unlimited;
}

std::size_t left(std::size_t limit, std::size_t used) { return limit > used ? limit - used : 0; }

}  // namespace

std::size_t memory_available() {
    std::size_t available = kilobytes("/proc/meminfo", "MemAvailable:", unlimited);
    rlimit address_space{};
    if (getrlimit(RLIMIT_AS, &address_space) == 0 && address_space.rlim_cur != RLIM_INFINITY)
        available =
            std::min(available, left(address_space.rlim_cur, kilobytes("/proc/self/status", "VmSize:", 0)));
    const std::size_t group_limit = number("/sys/fs/cgroup/memory.max");
    if (group_limit != unlimited)
        available = std::min(available, left(group_limit, number("/sys/fs/cgroup/memory.current")));
    return available;
}

std::size_t memory_in_use() { return kilobytes("/proc/self/status", "VmRSS:", 0); }

}  // namespace ruche
