#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <string>
#include <vector>

#include "ruche/core/parallel.hpp"

namespace ruche {

/// Appends the text of rows 0 to count-1 to `text`. `write(out, row)` formats one row; blocks of rows are
/// formatted in parallel and joined in order.
template <class Write>
void append_rows(std::string& text, std::size_t count, const Write& write) {
    constexpr std::size_t block = 4096;
    std::vector<std::string> parts((count + block - 1) / block);
    parallel_for(parts.size(), [&](std::size_t b) {
        fmt::memory_buffer buffer;
        for (std::size_t row = b * block; row < std::min(count, (b + 1) * block); ++row)
            write(std::back_inserter(buffer), row);
        parts[b] = fmt::to_string(buffer);
    });
    std::size_t size = text.size();
    for (const std::string& part : parts) size += part.size();
    text.reserve(size);
    for (const std::string& part : parts) text += part;
}

}  // namespace ruche
