#pragma once

#include <string>
#include <string_view>

namespace ruche {

/// Bytes as UTF-8 without a byte order mark, from UTF-8, UTF-16 with a mark, or else Windows-1252 (which
/// holds Latin-1); lines end with "\n" or "\r\n". Throws InputError, which names `file`, when it is no text.
std::string text_of(std::string_view bytes, const std::string& file);

}  // namespace ruche
