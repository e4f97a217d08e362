#pragma once

#include <string>

namespace ruche {

/// The exception that is being handled, as JSON: {"message": "kite.svg:3: ...", "key": "fabric.prestretch",
/// "problem": ..., "advice": ...}; only the message for what is no InputError. To be called in a catch block.
std::string current_error_json();

/// Whether it is a mistake of the user rather than a failure.
bool is_input_error();

}  // namespace ruche
