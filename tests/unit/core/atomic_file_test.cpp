#include "ruche/core/atomic_file.hpp"

#include <doctest/doctest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

using namespace ruche;
namespace fs = std::filesystem;

namespace {

struct Folder {
    fs::path path = fs::temp_directory_path() / ("ruche atomic ü " + std::to_string(::getpid()));
    Folder() { fs::create_directories(path); }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    ~Folder() { fs::remove_all(path); }
    std::string file(const char* name) const { return (path / name).string(); }
    std::size_t entries() const {
        return static_cast<std::size_t>(
            std::distance(fs::directory_iterator(path), fs::directory_iterator()));
    }
};

std::string contents(const std::string& path) {
    std::ostringstream text;
    text << std::ifstream(path, std::ios::binary).rdbuf();
    return text.str();
}

std::string failure(const std::string& path, std::string_view text) {
    try {
        write_file_atomically(path, text);
    } catch (const std::runtime_error& e) {
        return e.what();
    }
    return "";
}

/// Lowers the largest file size that this process may write.
struct SizeLimit {
    rlimit before = {};
    explicit SizeLimit(rlim_t bytes) {
        getrlimit(RLIMIT_FSIZE, &before);
        const rlimit lowered = {bytes, before.rlim_max};
        setrlimit(RLIMIT_FSIZE, &lowered);
    }
    SizeLimit(const SizeLimit&) = delete;
    SizeLimit& operator=(const SizeLimit&) = delete;
    ~SizeLimit() { setrlimit(RLIMIT_FSIZE, &before); }
};

}  // namespace

TEST_CASE("atomic file: contents replace the earlier file and nothing else is left") {
    const Folder folder;
    const std::string path = folder.file("a.txt");
    write_file_atomically(path, "first, and longer");
    write_file_atomically(path, std::string_view("a\0b", 3));
    CHECK(contents(path) == std::string("a\0b", 3));
    CHECK(folder.entries() == 1);
}

TEST_CASE("atomic file: without commit the earlier file stays and the new one disappears") {
    const Folder folder;
    const std::string path = folder.file("a.txt");
    write_file_atomically(path, "old");
    {
        const PendingFile pending(path, "new");
        CHECK(contents(path) == "old");
        CHECK(folder.entries() == 2);
    }
    CHECK(contents(path) == "old");
    CHECK(folder.entries() == 1);
}

TEST_CASE(
    "atomic file: a file size limit is an error with path and reason, not a signal, and the earlier file "
    "stays") {
    const Folder folder;
    const std::string path = folder.file("a.txt");
    write_file_atomically(path, "old");
    const std::string big(100000, 'x');
    {
        const SizeLimit limit(4096);
        const std::string message = failure(path, big);
        CHECK(message.find(path) != std::string::npos);
        CHECK(message.find("File too large") != std::string::npos);
    }
    CHECK(contents(path) == "old");
    CHECK(folder.entries() == 1);
    write_file_atomically(path, big);
    CHECK(contents(path) == big);
}

TEST_CASE("atomic file: a folder that does not exist and a folder in the way are named") {
    const Folder folder;
    CHECK(failure(folder.file("no/such/a.txt"), "x").find("No such file") != std::string::npos);
    fs::create_directories(folder.path / "b.txt");
    CHECK(failure(folder.file("b.txt"), "x").find("Is a directory") != std::string::npos);
    CHECK(folder.entries() == 1);
}
