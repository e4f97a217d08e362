#include "ruche/core/error.hpp"

namespace ruche {

std::string to_string(const Place& place) {
    std::string text = place.file;
    if (place.line > 0) text += (text.empty() ? "line " : ":") + std::to_string(place.line);
    if (!place.key.empty()) text += (text.empty() ? "" : ": ") + place.key;
    return text;
}

static std::string message(const Place& place, const std::string& problem, const std::string& advice) {
    std::string text = to_string(place);
    if (!text.empty()) text += ": ";
    text += problem;
    if (!advice.empty()) text += "\n  " + advice;
    // What is quoted from a file may be anything: a zero byte would end the message.
    for (char& c : text) {
        if (static_cast<unsigned char>(c) < 0x20U && c != '\n') c = '?';
    }
    return text;
}

InputError::InputError(const Place& place, const std::string& problem, const std::string& advice)
    : std::runtime_error(message(place, problem, advice)),
      place_(place),
      problem_(problem),
      advice_(advice) {}

}  // namespace ruche
