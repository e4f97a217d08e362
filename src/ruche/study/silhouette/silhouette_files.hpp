#pragma once

#include <string>
#include <vector>

#include "ruche/study/silhouette/silhouette_comparison.hpp"

namespace ruche {

/// A comparison, and the files that tell of it.
struct WrittenSilhouette {
    SilhouetteComparison found;
    std::vector<std::string> paths;
};

/// Compares the result in a folder with a photo's file and writes compare.json and silhouette.png into
/// `output`, which is made when it is missing. Throws InputError for what cannot be read or compared,
/// std::runtime_error when nothing can be written.
WrittenSilhouette compare_silhouette_files(const std::string& result, const std::string& photo,
                                           const std::string& output, const SilhouetteOptions& options);

}  // namespace ruche
