#include "ruche/core/error.hpp"

#include <doctest/doctest.h>

using namespace ruche;

TEST_CASE("InputError: the message names file, line and key, then what is wrong and how to mend it") {
    const InputError error({"k.toml", 14, "fabric.prestretch"}, "0.8 is outside [1, 3]",
                           "Not stretched is 1.");
    CHECK(std::string(error.what()) ==
          "k.toml:14: fabric.prestretch: 0.8 is outside [1, 3]\n  Not stretched is 1.");
    CHECK(std::string(InputError({}, "nothing").what()) == "nothing");
}

TEST_CASE("InputError: what was quoted from a binary file does not cut the message short") {
    const InputError error({"m.ply", 3, {}}, std::string("unknown word \"\0\x01\x1b[31m\"", 22), "Mend it.");
    CHECK(std::string(error.what()) == "m.ply:3: unknown word \"???[31m\"\n  Mend it.");
}
