#pragma once

#include <string>
#include <string_view>

#include "ruche/core/error.hpp"

namespace ruche::svg {

/// The text of an XML file as UTF-8 without a byte order mark, from UTF-8, UTF-16, or Latin-1 and
/// Windows-1252 when the XML declaration says so. Throws InputError at `place` for what is no text and for
/// bytes that are not in the encoding that the file claims.
std::string to_utf8(std::string_view bytes, const std::string& file);

}  // namespace ruche::svg
