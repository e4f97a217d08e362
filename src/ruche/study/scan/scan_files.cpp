#include "ruche/study/scan/scan_files.hpp"

#include <filesystem>

#include "ruche/core/atomic_file.hpp"
#include "ruche/output/html_report.hpp"
#include "ruche/scene/read_result.hpp"

namespace ruche {

WrittenComparison compare_files(const std::string& result, const std::string& scan, const std::string& output,
                                const ScanOptions& options, const Control& control) {
    const std::filesystem::path folder(output);
    const RawMesh points = read_surface(scan);
    const Result released = read_result(result);
    SurfaceFields fields = surface_fields(released, released.energy_density);
    WrittenComparison written{.found = compare_with_scan(released, fields, points, options, control),
                              .paths = {(folder / "compare.json").string()}};
    std::filesystem::create_directories(folder);
    const std::string json = to_json(written.found, scan);
    write_file_atomically(written.paths.back(), json);
    if (can_write_page()) {
        fields.scan_distance = written.found.vertex_distance;
        written.paths.push_back((folder / "compare.html").string());
        write_file_atomically(written.paths.back(), html_report(released, fields, json));
    }
    return written;
}

}  // namespace ruche
