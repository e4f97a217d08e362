#include "ruche/core/suggest.hpp"

#include <doctest/doctest.h>

using namespace ruche;

TEST_CASE("did_you_mean: finds misspelt keys, swapped letters and forgotten units") {
    const std::vector<std::string_view> keys = {"fabric_thickness_mm", "prestretch", "thickness_mm", "side"};
    CHECK(did_you_mean("fabric_thicknes_mm", keys) == "; did you mean fabric_thickness_mm?");
    CHECK(did_you_mean("prestrecth", keys) == "; did you mean prestretch?");
    CHECK(did_you_mean("thickness", keys) == "; did you mean thickness_mm?");
    CHECK(did_you_mean("thickness_cm", keys) == "; did you mean thickness_mm?");
    CHECK(did_you_mean("sied", keys) == "; did you mean side?");
}

TEST_CASE("did_you_mean: is silent when nothing is near") {
    CHECK(did_you_mean("colour", {"prestretch", "side"}).empty());
    CHECK(did_you_mean("x", {"y", "prestretch"}) == "; did you mean y?");
    CHECK(did_you_mean(std::string(100000, 'a'), {"side"}).empty());
    CHECK(did_you_mean("side", {}).empty());
}
