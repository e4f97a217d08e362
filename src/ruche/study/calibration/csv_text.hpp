#pragma once

#include <string>
#include <string_view>

namespace ruche {

/// Bytes as UTF-8 without a byte order mark, from UTF-8, UTF-16 (with a mark, or beginning with ASCII), or
/// else Windows-1252 (which holds Latin-1); lines end with "\n" or "\r\n". Throws InputError, which names
/// `file` and the kind of file that it seems to be, when it is no text that could be a table.
std::string text_of(std::string_view bytes, const std::string& file);

}  // namespace ruche
