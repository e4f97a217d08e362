#pragma once

#include <stdexcept>
#include <string>

namespace ruche {

/// Where in the user's input something was found.
struct Place {
    std::string file;  ///< path as the user gave it; empty when it came from the command line or from Python
    int line = 0;      ///< 1-based; 0 when unknown
    std::string key;   ///< "fabric.prestretch", "element #12 'strip-3'", ...
};

/// A mistake in the user's input: the message names the file, the place, what was found and what was
/// expected; `advice` says how to mend it. The program ends with exit code 2.
class InputError : public std::runtime_error {
  public:
    InputError(const Place& place, const std::string& problem, const std::string& advice = {});

    const Place& place() const { return place_; }
    const std::string& problem() const { return problem_; }
    const std::string& advice() const { return advice_; }

  private:
    Place place_;
    std::string problem_;
    std::string advice_;
};

/// "kite.toml:14: fabric.prestretch" with the parts that are known.
std::string to_string(const Place& place);

}  // namespace ruche
