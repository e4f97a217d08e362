#pragma once

#include <string>

namespace ruche {

/// A self-contained page: title, the style that all pages of studies share, and a body of HTML.
std::string html_page(const std::string& title, const std::string& body);

/// A paragraph of plain text.
std::string html_paragraph(const std::string& text);

}  // namespace ruche
