#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

namespace ruche::test {

/// A file of a given name, in a folder of its own, that is gone with this object.
class TemporaryFile {
  public:
    explicit TemporaryFile(std::string_view bytes, const std::string& name = "file") {
        // The address tells apart what runs in one process; every process has a temporary folder of its own.
        folder_ =
            std::filesystem::temp_directory_path() / std::to_string(reinterpret_cast<std::uintptr_t>(this));
        std::filesystem::create_directories(folder_);
        path_ = (folder_ / name).string();
        std::ofstream(path_, std::ios::binary) << bytes;
    }
    ~TemporaryFile() { std::filesystem::remove_all(folder_); }
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;

    const std::string& path() const { return path_; }

  private:
    std::filesystem::path folder_;
    std::string path_;
};

}  // namespace ruche::test
