#include "ruche/core/suggest.hpp"

#include <algorithm>
#include <cstddef>

namespace ruche {

/// Number of single-letter insertions, deletions, replacements and swaps of neighbours (optimal string
/// alignment) that lead from one text to the other.
static std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> before(b.size() + 1);
    std::vector<std::size_t> above(b.size() + 1);
    std::vector<std::size_t> row(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j) above[j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            row[j] = std::min({above[j] + 1, row[j - 1] + 1, above[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                row[j] = std::min(row[j], before[j - 2] + 1);
        }
        before.swap(above);
        above.swap(row);
    }
    return above[b.size()];
}

/// "thickness" for "thickness_mm": a forgotten or wrong unit should still find its key.
static std::string_view first_words(std::string_view key) { return key.substr(0, key.rfind('_')); }

std::string did_you_mean(std::string_view written, const std::vector<std::string_view>& candidates) {
    constexpr std::size_t longest_key = 64;
    if (written.size() > longest_key) return {};
    std::string_view best;
    std::size_t best_distance = std::max<std::size_t>(1, written.size() / 3) + 1;
    for (const std::string_view candidate : candidates) {
        std::size_t distance = edit_distance(written, candidate);
        if (first_words(candidate) == written || first_words(candidate) == first_words(written))
            distance = std::min<std::size_t>(distance, 1);
        if (distance < best_distance) {
            best = candidate;
            best_distance = distance;
        }
    }
    return best.empty() ? std::string() : "; did you mean " + std::string(best) + "?";
}

}  // namespace ruche
