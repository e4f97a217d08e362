#pragma once

#include <string>
#include <vector>

#include "ruche/study/scan/scan_comparison.hpp"

namespace ruche {

/// A comparison, and the files that tell of it.
struct WrittenComparison {
    ScanComparison found;
    std::vector<std::string> paths;
};

/// Compares the result in a folder with a scan's file and writes compare.json and, where the program can,
/// compare.html into `output`, which is made when it is missing. Throws InputError for what cannot be read
/// or compared, std::runtime_error when nothing can be written.
WrittenComparison compare_files(const std::string& result, const std::string& scan, const std::string& output,
                                const ScanOptions& options, const Control& control = {});

}  // namespace ruche
