#pragma once

#include <string>
#include <string_view>

namespace ruche {

/// A complete file that waits for its name. The constructor writes `contents` under a temporary name in the
/// folder of `path`; `commit` renames it, so that a reader sees the earlier file or the whole new one, never
/// a part. Without `commit` the destructor removes the temporary file. Everything throws std::runtime_error
/// with path and reason when it fails (disk full, file size limit, no permission); the earlier file stays.
class PendingFile {
  public:
    PendingFile(std::string path, std::string_view contents);
    PendingFile(PendingFile&& other) noexcept;
    PendingFile(const PendingFile&) = delete;
    PendingFile& operator=(const PendingFile&) = delete;
    PendingFile& operator=(PendingFile&&) = delete;
    ~PendingFile();

    const std::string& path() const { return path_; }
    void commit();

  private:
    std::string path_;
    std::string temporary_;  ///< empty once committed
};

/// Writes one file at once: `PendingFile` and its `commit`.
void write_file_atomically(const std::string& path, std::string_view contents);

}  // namespace ruche
