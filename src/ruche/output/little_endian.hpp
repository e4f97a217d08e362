#pragma once

#include <bit>
#include <cstring>
#include <string>

namespace ruche {

static_assert(std::endian::native == std::endian::little,
              "binary exports write numbers as they lie in memory");

/// Appends a number's bytes, little endian.
template <class Number>
void append_bytes(std::string& out, Number value) {
    char bytes[sizeof(Number)];
    std::memcpy(bytes, &value, sizeof(Number));
    out.append(bytes, sizeof(Number));
}

}  // namespace ruche
