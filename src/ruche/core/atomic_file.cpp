#include "ruche/core/atomic_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <filesystem>
#include <stdexcept>
#include <system_error>
#include <utility>

namespace ruche {
namespace {

[[noreturn]] void fail(const std::string& path, int error) {
    throw std::runtime_error(
        fmt::format("cannot write {}: {}", path, std::generic_category().message(error)));
}

/// A write beyond the process's file size limit raises SIGXFSZ, which would end the program; while one of
/// these lives, this thread gets the error EFBIG instead.
class FileSizeSignalBlock {
  public:
    FileSizeSignalBlock() {
        sigemptyset(&signal_);
        sigaddset(&signal_, SIGXFSZ);
        sigset_t pending;
        sigpending(&pending);
        was_pending_ = sigismember(&pending, SIGXFSZ) == 1;
        pthread_sigmask(SIG_BLOCK, &signal_, &before_);
    }
    FileSizeSignalBlock(const FileSizeSignalBlock&) = delete;
    FileSizeSignalBlock& operator=(const FileSizeSignalBlock&) = delete;
    ~FileSizeSignalBlock() {
        const timespec no_wait = {0, 0};
        if (!was_pending_) sigtimedwait(&signal_, nullptr, &no_wait);
        pthread_sigmask(SIG_SETMASK, &before_, nullptr);
    }

  private:
    sigset_t signal_;
    sigset_t before_;
    bool was_pending_ = false;
};

/// 0, or the error that stopped it.
int write_all(int descriptor, std::string_view contents) {
    const FileSizeSignalBlock block;
    while (!contents.empty()) {
        const ssize_t written = ::write(descriptor, contents.data(), contents.size());
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) return errno;
        if (written == 0) return ENOSPC;
        contents.remove_prefix(static_cast<std::size_t>(written));
    }
    return 0;
}

struct OpenFile {
    int descriptor = -1;
    std::string name;
};

OpenFile open_temporary(const std::string& path) {
    static std::atomic<unsigned> counter{0};
    const std::filesystem::path folder = std::filesystem::path(path).parent_path();
    for (;;) {
        const std::string name =
            (folder / fmt::format(".ruche-{}-{}.tmp", ::getpid(), counter.fetch_add(1))).string();
        const int descriptor = ::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (descriptor >= 0) return {descriptor, name};
        if (errno != EEXIST && errno != EINTR) fail(path, errno);
    }
}

}  // namespace

PendingFile::PendingFile(std::string path, std::string_view contents) : path_(std::move(path)) {
    // rename() would only complain at the end, when other files may already have been replaced.
    struct stat found = {};
    if (::stat(path_.c_str(), &found) == 0 && S_ISDIR(found.st_mode)) fail(path_, EISDIR);
    const OpenFile file = open_temporary(path_);
    int error = write_all(file.descriptor, contents);
    if (::close(file.descriptor) != 0 && error == 0) error = errno;
    if (error != 0) {
        ::unlink(file.name.c_str());
        fail(path_, error);
    }
    temporary_ = file.name;
}

PendingFile::PendingFile(PendingFile&& other) noexcept
    : path_(std::move(other.path_)), temporary_(std::exchange(other.temporary_, {})) {}

PendingFile::~PendingFile() {
    if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

void PendingFile::commit() {
    if (temporary_.empty()) return;
    if (::rename(temporary_.c_str(), path_.c_str()) != 0) fail(path_, errno);
    temporary_.clear();
}

void write_file_atomically(const std::string& path, std::string_view contents) {
    PendingFile(path, contents).commit();
}

}  // namespace ruche
