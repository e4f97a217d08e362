#include "ruche/output/packed_arrays.hpp"

#include <doctest/doctest.h>

#include <Eigen/Core>
#include <cmath>
#include <cstring>
#include <limits>
#include "ruche/core/error.hpp"

using namespace ruche;

namespace {

template <class Number>
Number stored(const PackedArrays& arrays, const PackedArray& about, std::size_t i) {
    Number value;
    std::memcpy(&value, arrays.bytes().data() + about.at + i * sizeof(Number), sizeof(Number));
    return value;
}

}  // namespace

TEST_CASE("packed arrays: whole numbers take the smallest type that also holds none") {
    PackedArrays arrays;
    const std::vector<int> small = {0, 254, -1}, medium = {0, 255, -1}, large = {0, 65535, -1};
    arrays.add_numbers("small", small);
    arrays.add_numbers("medium", medium);
    arrays.add_numbers("large", large, 3);
    const auto& list = arrays.list();
    REQUIRE(list.size() == 3);
    CHECK(list[0].type == "u8");
    CHECK(stored<std::uint8_t>(arrays, list[0], 2) == 255);
    CHECK(list[1].type == "u16");
    CHECK(stored<std::uint16_t>(arrays, list[1], 1) == 255);
    CHECK(stored<std::uint16_t>(arrays, list[1], 2) == 65535);
    CHECK(list[2].type == "u32");
    CHECK(list[2].count == 1);
    CHECK(stored<std::uint32_t>(arrays, list[2], 2) == 0xffffffffU);
    for (const PackedArray& about : list) CHECK(about.at % 4 == 0);
}

TEST_CASE("packed arrays: even steps are exact to half a step in each component") {
    PackedArrays arrays;
    std::vector<double> values;
    for (int i = 0; i < 500; ++i)
        values.insert(values.end(), {std::sin(0.1 * i), 200.0 * std::cos(0.37 * i)});
    arrays.add_even("xy", values, 2);
    const PackedArray& about = arrays.list()[0];
    CHECK(about.count == 500);
    for (std::size_t i = 0; i < values.size(); ++i) {
        const double back =
            about.origin[i % 2] + about.scale[i % 2] * stored<std::uint16_t>(arrays, about, i);
        CHECK(std::abs(back - values[i]) <= 0.5000001 * about.scale[i % 2]);
    }
    CHECK(about.scale[1] == doctest::Approx(400.0 / 65535).epsilon(1e-3));
}

TEST_CASE("packed arrays: constant values come back exactly") {
    PackedArrays arrays;
    arrays.add_even("front_mm", std::vector<double>{0.6, 0.6, 0.6});
    const PackedArray& about = arrays.list()[0];
    CHECK(about.origin[0] + about.scale[0] * stored<std::uint16_t>(arrays, about, 1) == 0.6);
}

TEST_CASE("packed arrays: relative ones keep eleven bits over many decades, and what is not a number") {
    PackedArrays arrays;
    const std::vector<double> values = {1e-4, -0.152362, 3.0, 1234.5, -1e9, std::nan("")};
    arrays.add_relative("curvature", values);
    const PackedArray& about = arrays.list()[0];
    const auto back = [&](std::size_t i) {
        return static_cast<float>(
            Eigen::numext::bit_cast<Eigen::half>(stored<std::uint16_t>(arrays, about, i)));
    };
    for (std::size_t i = 0; i < 4; ++i) CHECK(std::abs(back(i) - values[i]) <= std::abs(values[i]) / 2048.0);
    CHECK(back(4) == -65504.0F);
    CHECK(std::isnan(back(5)));
}

TEST_CASE("base64: the test vectors of RFC 4648, and bytes above 127") {
    CHECK(base64("").empty());
    CHECK(base64("f") == "Zg==");
    CHECK(base64("fo") == "Zm8=");
    CHECK(base64("foo") == "Zm9v");
    CHECK(base64("foobar") == "Zm9vYmFy");
    CHECK(base64("\xff\xfe\xfd") == "//79");
    for (const std::string text : {"", "f", "fo", "foo", "foobar", "\xff\xfe\xfd"})
        CHECK(from_base64(base64(text)) == text);
    for (const char* wrong : {"Zg", "Zg=", "Zg==Zg==", "Z===", "Zm9v!A==", "Zm9v\n", "A"})
        CHECK_THROWS_AS((void)from_base64(wrong), InputError);
}
