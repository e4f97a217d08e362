#pragma once

#include <string>

#include "ruche/output/image.hpp"

namespace ruche {

/// Whether a file begins as PNG and JPEG files do. False for a file that cannot be read.
bool is_photo(const std::string& path);

/// Reads a photo, pixels in the order in which the file stores them (a tag that asks viewers to turn it is
/// not followed); what is transparent becomes white. Throws InputError for what is neither PNG nor JPEG, is
/// broken, or has more than 200 million pixels.
Image read_photo(const std::string& path);

}  // namespace ruche
