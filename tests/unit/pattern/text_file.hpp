#pragma once

#include <filesystem>
#include <fstream>
#include <string>

namespace ruche::test {

/// A text file in the temporary folder that goes away with the test.
class TextFile {
  public:
    explicit TextFile(const std::string& text) {
        static int count = 0;
        path_ = std::filesystem::temp_directory_path() /
                ("ruche-text-" + std::to_string(reinterpret_cast<std::uintptr_t>(this)) + "-" +
                 std::to_string(++count) + ".csv");
        std::ofstream(path_, std::ios::binary) << text;
    }
    ~TextFile() { std::filesystem::remove(path_); }
    TextFile(const TextFile&) = delete;
    TextFile& operator=(const TextFile&) = delete;
    std::string path() const { return path_.string(); }

  private:
    std::filesystem::path path_;
};

}  // namespace ruche::test
