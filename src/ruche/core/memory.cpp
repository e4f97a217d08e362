#include "ruche/core/memory.hpp"

#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <memory>
#include <string>

#include "ruche/core/parallel.hpp"

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

void hand_out(std::span<double> array) {
    constexpr std::size_t piece = std::size_t{16} << 20U;  // bytes
    const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
    void* begin = array.data();
    std::size_t size = array.size_bytes();
    if (std::align(page, page, begin, size) == nullptr) return;
    size -= size % page;  // the rest may be in a page of somebody else's
    parallel_for((size + piece - 1) / piece, [&](std::size_t i) {
        // It fails before Linux 5.14, and then the pages come one by one as ever.
        madvise(static_cast<char*>(begin) + i * piece, std::min(piece, size - i * piece),
                MADV_POPULATE_WRITE);
    });
}

}  // namespace ruche
