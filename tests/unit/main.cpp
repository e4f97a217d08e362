#define DOCTEST_CONFIG_IMPLEMENT
#include <doctest/doctest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <system_error>

/// Every run works in a folder of its own, removed at the end: CTest runs each test case as a process of its
/// own, several at a time, and two that write a file of one name would read each other's.
int main(int argc, char** argv) {
    // Property tests draw the same cases in every run, unless RC_PARAMS asks for others.
    setenv("RC_PARAMS", "seed=20221122", 0);
    const std::filesystem::path start = std::filesystem::current_path();
    const std::filesystem::path folder =
        std::filesystem::temp_directory_path() / ("ruche-test-" + std::to_string(getpid()));
    std::filesystem::create_directories(folder);
    std::filesystem::current_path(folder);
    setenv("TMPDIR", folder.c_str(), 1);
    const int code = doctest::Context(argc, argv).run();
    std::filesystem::current_path(start);
    std::error_code ignored;
    std::filesystem::remove_all(folder, ignored);
    return code;
}
