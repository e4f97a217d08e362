#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "ruche/core/error.hpp"
#include "ruche/core/fields.hpp"
#include "ruche/pattern/generated_pattern.hpp"

namespace ruche {

/// The key of the one option of generators that names a file to read.
inline constexpr const char* generator_file_option = "file";

/// One option of a generator, for help and manual.
struct GeneratorOption {
    std::string key;      ///< "width_mm"
    std::string initial;  ///< the default, as it would be written
    std::string unit;
    std::string range;  ///< "[0.1, 50]", "butt | round", or ""
    std::string meaning;
    FieldInfo field;  ///< kind and bounds, for a form
};

struct GeneratorInfo {
    std::string name;
    std::string summary;  ///< one sentence
    std::vector<GeneratorOption> options;
};

/// All generators, in the order of the manual.
std::vector<GeneratorInfo> generators();
std::vector<std::string> generator_names();

/// Runs a generator by name with options as written in a scene or on the command line. Throws InputError
/// (with `place` as its place, the option's key appended) for unknown names and options, with the nearest
/// known one as suggestion, for values of the wrong type or out of range, and for contradictions.
GeneratedPattern generate(std::string_view name, const std::map<std::string, std::string>& options,
                          const Place& place = {});

}  // namespace ruche
