#pragma once

#include <filesystem>
#include <map>
#include <mutex>
#include <stdexcept>
#include <string>
#include <vector>

namespace ruche {

/// A path that does not stay in the folder.
class OutsideFolder : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// A result that lies in the folder, whoever wrote it.
struct RunEntry {
    std::string folder;     ///< relative: "torus.out"
    double written = 0;     ///< seconds since 1970
    std::string summary;    ///< JSON object: status, stable, box_size_mm, strips' curvatures, settings, ...
    bool page = false;      ///< whether there is a report.html
    bool compared = false;  ///< whether there is a compare.html, of a scan
    bool photographed = false;  ///< whether there is a silhouette.png
};

/// The folder that the studio works in: drawings, scene files and results, which the command line reads and
/// writes as well. Nothing outside it is touched.
class Workspace {
  public:
    /// Throws InputError when there is no such folder.
    explicit Workspace(const std::string& folder);

    const std::filesystem::path& root() const { return root_; }

    /// The path of something in the folder, links followed. Throws OutsideFolder when it leads elsewhere.
    std::filesystem::path inside(const std::string& relative) const;

    /// Drawings (.svg) and scene files (.toml with a [pattern]) in the folder, not in those below.
    std::vector<std::string> drawings() const;
    std::vector<std::string> scenes() const;
    /// Material cards in the folder.
    std::vector<std::string> cards() const;
    /// Scans (.obj, .ply, .stl) in the folder itself; those in results are shapes.
    std::vector<std::string> scans() const;

    /// All results, in folders up to three levels down; latest first.
    std::vector<RunEntry> runs();

    /// Writes an uploaded drawing and returns its name: the wanted one without anything but letters, digits,
    /// '-', '_', '.', and with a number where a file of that name has other contents. Throws InputError for
    /// text that cannot be a drawing.
    std::string keep_drawing(const std::string& wanted, const std::string& text) const;

    /// The same with an uploaded scan or photo, whose contents are looked at when it is used.
    std::string keep_measured(const std::string& wanted, const std::string& bytes) const;

    /// A name for the folder of a new result: "torus.out", "torus-2.out", ... none of `taken`.
    std::string new_result(const std::string& name, const std::vector<std::string>& taken) const;

    /// A file that may be handed out: of a result, or a drawing or a scene. Empty when it is none.
    std::filesystem::path served_file(const std::string& relative) const;

  private:
    std::string keep(const std::string& stem, const std::string& ending, const std::string& bytes) const;

    struct Known {
        std::filesystem::file_time_type time;
        RunEntry entry;
    };
    std::filesystem::path root_;  // without links
    std::mutex mutex_;
    std::map<std::string, Known> known_;
};

}  // namespace ruche
