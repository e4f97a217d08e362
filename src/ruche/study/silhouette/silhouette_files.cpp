#include "ruche/study/silhouette/silhouette_files.hpp"

#include <filesystem>

#include "ruche/core/atomic_file.hpp"
#include "ruche/scene/read_result.hpp"
#include "ruche/study/silhouette/photo.hpp"

namespace ruche {

WrittenSilhouette compare_silhouette_files(const std::string& result, const std::string& photo,
                                           const std::string& output, const SilhouetteOptions& options) {
    const std::filesystem::path folder(output);
    const Image picture = read_photo(photo);
    const Result released = read_result(result);
    WrittenSilhouette written{
        .found = compare_with_photo(released, surface_fields(released), picture, options, photo),
        .paths = {(folder / "compare.json").string(), (folder / "silhouette.png").string()}};
    std::filesystem::create_directories(folder);
    write_file_atomically(written.paths[0], to_json(written.found, photo));
    write_file_atomically(written.paths[1], to_png(annotated(picture, written.found)));
    return written;
}

}  // namespace ruche
