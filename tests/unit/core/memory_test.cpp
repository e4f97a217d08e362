#include "ruche/core/memory.hpp"

#include <doctest/doctest.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <memory>
#include <numeric>
#include <span>
#include <vector>

using namespace ruche;

namespace {

/// One flag per whole page of an array: the system has handed it out.
std::vector<bool> handed_out(std::span<double> array) {
    const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
    void* begin = array.data();
    std::size_t size = array.size_bytes();
    std::align(page, page, begin, size);
    std::vector<unsigned char> pages(size / page);
    REQUIRE(mincore(begin, pages.size() * page, pages.data()) == 0);
    std::vector<bool> there;
    there.reserve(pages.size());
    for (const unsigned char flags : pages) there.push_back((flags & 1U) != 0);
    return there;
}

}  // namespace

TEST_CASE("memory: a large array is handed out at once") {
    const std::size_t length = std::size_t{5} << 20U;  // 40 MB: more than one piece
    const auto values = std::make_unique_for_overwrite<double[]>(length);
    const std::span<double> array(values.get(), length);
    REQUIRE(std::ranges::count(handed_out(array), true) < 100);
    hand_out(array);
    CHECK(std::ranges::count(handed_out(array), false) == 0);
}

TEST_CASE("memory: what an array holds stays when it is handed out") {
    std::vector<double> values(100'000);
    std::iota(values.begin(), values.end(), 0.0);
    hand_out(std::span(values).subspan(3, 90'001));
    hand_out(std::span(values).subspan(3, 1));
    hand_out({});
    std::vector<double> expected(values.size());
    std::iota(expected.begin(), expected.end(), 0.0);
    CHECK(values == expected);
}
