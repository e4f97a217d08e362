#include "ruche/statics/supernodal_factor.hpp"

#include <cblas.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstring>
#include <functional>
#include <numeric>

#include "ruche/core/memory.hpp"
#include "ruche/core/parallel.hpp"

extern "C" void dpotrf_(const char* uplo, const int* n, double* a, const int* lda, int* info);

namespace ruche {
namespace {

constexpr int tile_columns = 128;  // of a large panel: what one thread works on
constexpr int tile_rows = 256;
constexpr double largest_subtree = 1.0 / 24.0;  // of the whole work: several threads are busy to the end

/// Factors the leading columns of a panel in place; false when a pivot is not positive.
bool factor_diagonal(int columns, double* panel, int stride) {
    int info = 0;
    dpotrf_("L", &columns, panel, &stride, &info);
    if (info != 0) return false;
    // A pivot that is not a number passes LAPACK's test.
    for (int c = 0; c < columns; ++c) {
        const double pivot = panel[c + static_cast<std::size_t>(c) * stride];
        if (!(pivot > 0.0) || !std::isfinite(pivot)) return false;
    }
    return true;
}

/// below <- below diagonal^-T, both in one panel.
void solve_below(int rows, int columns, const double* diagonal, double* below, int stride) {
    if (rows == 0) return;
    cblas_dtrsm(CblasColMajor, CblasRight, CblasLower, CblasTrans, CblasNonUnit, rows, columns, 1.0, diagonal,
                stride, below, stride);
}

/// The lower trapezoid of c <- a a_top^T * scale + c * keep, a_top being the first `width` of a's `height`
/// rows.
struct Trapezoid {
    int width, height, depth;
};
void multiply(const Trapezoid& size, double scale, const double* a, int a_stride, double keep, double* c,
              int c_stride) {
    cblas_dsyrk(CblasColMajor, CblasLower, CblasNoTrans, size.width, size.depth, scale, a, a_stride, keep, c,
                c_stride);
    if (size.height == size.width) return;
    cblas_dgemm(CblasColMajor, CblasNoTrans, CblasTrans, size.height - size.width, size.width, size.depth,
                scale, a + size.width, a_stride, a, a_stride, keep, c + size.width, c_stride);
}

int tiles(int length, int tile) { return (length + tile - 1) / tile; }

}  // namespace

SupernodalFactor::SupernodalFactor(SupernodalStructure structure, const SymmetricPattern& pattern,
                                   std::span<const int> node_sizes)
    : structure_(std::move(structure)), supernode_of_column_(structure_.size()) {
    for (int s = 0; s < structure_.supernode_count(); ++s) {
        for (int c = structure_.first_column[s]; c < structure_.first_column[s + 1]; ++c)
            supernode_of_column_[c] = s;
    }
    list_blocks(pattern, node_sizes);
    list_updates();
    split_tree();
}

void SupernodalFactor::list_blocks(const SymmetricPattern& pattern, std::span<const int> node_sizes) {
    const int size = structure_.size();
    const int nodes = static_cast<int>(node_sizes.size());
    std::vector<int> eliminated_at(size);
    for (int k = 0; k < size; ++k) eliminated_at[structure_.permutation[k]] = k;
    std::vector<int> first_unknown(nodes + 1, 0);
    std::partial_sum(node_sizes.begin(), node_sizes.end(), first_unknown.begin() + 1);
    std::vector<int> node_of(size);
    for (int node = 0; node < nodes; ++node)
        std::fill_n(node_of.begin() + first_unknown[node], node_sizes[node], node);
    const auto for_each_block = [&](auto&& use) {
        for (int node = 0; node < nodes; ++node) {
            const int column = first_unknown[node];
            const int end = pattern.column_start[column + 1];
            for (int k = pattern.column_start[column]; k < end;) {
                const int row = pattern.row_index[k];
                const int rows = node_sizes[node_of[row]];
                if (row >= column) use(node, k, eliminated_at[row], rows);
                k += rows;
            }
        }
    };
    first_block_.assign(structure_.supernode_count() + 1, 0);
    for_each_block([&](int node, int, int row, int) {
        const int column = eliminated_at[first_unknown[node]];
        ++first_block_[supernode_of_column_[std::min(row, column)] + 1];
    });
    std::partial_sum(first_block_.begin(), first_block_.end(), first_block_.begin());
    blocks_.resize(first_block_.back());
    std::vector<int> column_of_block(blocks_.size());
    std::vector<int> next(first_block_.begin(), first_block_.end() - 1);
    for_each_block([&](int node, int source, int row, int rows) {
        const int unknown = first_unknown[node];
        const int column = eliminated_at[unknown];
        const int block = next[supernode_of_column_[std::min(row, column)]]++;
        column_of_block[block] = std::min(row, column);
        blocks_[block] = {
            .source = source,
            .source_stride = pattern.column_start[unknown + 1] - pattern.column_start[unknown],
            .target = std::max(row, column),  // its row, so far
            .rows = static_cast<short>(rows),
            .columns = static_cast<short>(node_sizes[node]),
            .transposed = row < column,
        };
    });
    std::vector<int> position(size);  // of each row in the panel of a supernode that has it
    for (int s = 0; s < structure_.supernode_count(); ++s) {
        const int stride = structure_.panel_rows(s);
        for (int i = 0; i < stride; ++i) position[structure_.panel_row(s)[i]] = i;
        for (int b = first_block_[s]; b < first_block_[s + 1]; ++b) {
            const int across = column_of_block[b] - structure_.first_column[s];
            blocks_[b].target = position[blocks_[b].target] + across * stride;
        }
    }
}

void SupernodalFactor::list_updates() {
    const auto for_each_update = [&](auto&& use) {
        for (int s = 0; s < structure_.supernode_count(); ++s) {
            const int rows = structure_.panel_rows(s);
            const auto target = [&](int row) { return supernode_of_column_[structure_.panel_row(s)[row]]; };
            for (int begin = structure_.columns(s); begin < rows;) {
                int end = begin + 1;
                while (end < rows && target(end) == target(begin)) ++end;
                use(target(begin), Update{s, begin, end});
                begin = end;
            }
        }
    };
    first_update_.assign(structure_.supernode_count() + 1, 0);
    for_each_update([&](int to, const Update&) { ++first_update_[to + 1]; });
    std::partial_sum(first_update_.begin(), first_update_.end(), first_update_.begin());
    updates_.resize(first_update_.back());
    std::vector<int> next(first_update_.begin(), first_update_.end() - 1);
    for_each_update([&](int to, const Update& update) { updates_[next[to]++] = update; });
}

/// Multiplications that a supernode causes, in its own panel and in those it updates, up to a factor.
double SupernodalFactor::work(int s) const {
    const double rows = structure_.panel_rows(s);
    return structure_.columns(s) * rows * rows;
}

/// Cuts the elimination tree into subtrees none of which holds more than a small share of the work.
void SupernodalFactor::split_tree() {
    const int count = structure_.supernode_count();
    std::vector<int> parent(count, -1);
    std::vector<double> below(count, 0.0);
    double whole = 0.0;
    for (int s = 0; s < count; ++s) {
        whole += work(s);
        below[s] += work(s);
        if (structure_.panel_rows(s) == structure_.columns(s)) continue;
        parent[s] = supernode_of_column_[structure_.panel_row(s)[structure_.columns(s)]];
        below[parent[s]] += below[s];
    }
    std::vector<int> subtree_of(count, -1);
    for (int s = count - 1; s >= 0; --s) {
        if (parent[s] >= 0 && subtree_of[parent[s]] >= 0) {
            subtree_of[s] = subtree_of[parent[s]];
        } else if (below[s] <= largest_subtree * whole) {
            subtree_of[s] = static_cast<int>(tree_.subtrees.size());
            tree_.subtrees.push_back({.work = below[s]});
        }
    }
    for (int s = 0; s < count; ++s)
        (subtree_of[s] < 0 ? tree_.top : tree_.subtrees[subtree_of[s]].supernodes).push_back(s);
    // Short ones fill the gaps at the end.
    std::ranges::stable_sort(tree_.subtrees, std::ranges::greater(), &TreeSplit::Subtree::work);
}

void SupernodalFactor::place_blocks(int s, std::span<const double> values) {
    double* to = panel(s);
    std::fill(to, panel(s + 1), 0.0);
    const int stride = structure_.panel_rows(s);
    for (int b = first_block_[s]; b < first_block_[s + 1]; ++b) {
        const Block& block = blocks_[b];
        const int down = block.transposed ? stride : 1;
        const int across = block.transposed ? 1 : stride;
        for (int c = 0; c < block.columns; ++c) {
            for (int r = 0; r < block.rows; ++r) {
                to[block.target + r * down + c * across] +=
                    values[block.source + r + c * block.source_stride];
            }
        }
    }
}

/// Subtracts the updates of all supernodes below from columns [first_column, last_column) of a panel.
void SupernodalFactor::gather_updates(int s, int first_column, int last_column, Workspace& workspace) {
    workspace.position.resize(structure_.size());
    int* position = workspace.position.data();
    const int stride = structure_.panel_rows(s);
    for (int i = 0; i < stride; ++i) position[structure_.panel_row(s)[i]] = i;
    for (int u = first_update_[s]; u < first_update_[s + 1]; ++u) {
        const Update& update = updates_[u];
        const int* rows = structure_.panel_row(update.from);
        const int* begin = std::lower_bound(rows + update.begin, rows + update.end, first_column);
        const int* end = std::lower_bound(begin, rows + update.end, last_column);
        if (begin == end) continue;
        const int from_stride = structure_.panel_rows(update.from);
        const Trapezoid size{.width = static_cast<int>(end - begin),
                             .height = static_cast<int>(rows + from_stride - begin),
                             .depth = structure_.columns(update.from)};
        const std::size_t needed = static_cast<std::size_t>(size.width) * size.height;
        if (workspace.product.size() < needed) workspace.product.resize(needed);
        double* product = workspace.product.data();
        multiply(size, 1.0, panel(update.from) + (begin - rows), from_stride, 0.0, product, size.height);
        for (int c = 0; c < size.width; ++c, product += size.height) {
            double* to = panel(s) + static_cast<std::size_t>(position[begin[c]]) * stride;
            for (int r = c; r < size.height; ++r) to[position[begin[r]]] -= product[r];
        }
    }
}

bool SupernodalFactor::factor_alone(int s, std::span<const double> values, Workspace& workspace) {
    const int columns = structure_.columns(s);
    const int rows = structure_.panel_rows(s);
    place_blocks(s, values);
    gather_updates(s, structure_.first_column[s], structure_.first_column[s + 1], workspace);
    if (!factor_diagonal(columns, panel(s), rows)) return false;
    solve_below(rows - columns, columns, panel(s), panel(s) + columns, rows);
    return true;
}

/// All threads work on one panel: on the updates of its column tiles, then on the tiles of its factorisation.
bool SupernodalFactor::factor_together(int s, std::span<const double> values) {
    const int columns = structure_.columns(s);
    const int rows = structure_.panel_rows(s);
    const int first = structure_.first_column[s];
    const auto at = [&](int row, int column) {
        return panel(s) + row + static_cast<std::size_t>(column) * rows;
    };
    place_blocks(s, values);
    parallel_for_workers(tiles(columns, tile_columns), [&](std::size_t tile, int worker) {
        const int begin = static_cast<int>(tile) * tile_columns;
        gather_updates(s, first + begin, first + std::min(columns, begin + tile_columns),
                       workspaces_[worker]);
    });
    for (int begin = 0; begin < columns; begin += tile_columns) {
        const int end = std::min(columns, begin + tile_columns);
        if (!factor_diagonal(end - begin, at(begin, begin), rows)) return false;
        parallel_for(tiles(rows - end, tile_rows), [&](std::size_t tile) {
            const int row = end + static_cast<int>(tile) * tile_rows;
            solve_below(std::min(tile_rows, rows - row), end - begin, at(begin, begin), at(row, begin), rows);
        });
        parallel_for(tiles(columns - end, tile_columns), [&](std::size_t tile) {
            const int column = end + static_cast<int>(tile) * tile_columns;
            const Trapezoid size{.width = std::min(tile_columns, columns - column),
                                 .height = rows - column,
                                 .depth = end - begin};
            multiply(size, -1.0, at(column, begin), rows, 1.0, at(column, column), rows);
        });
    }
    return true;
}

void SupernodalFactor::make_room() {
    if (values_) return;
    values_ = std::make_unique_for_overwrite<double[]>(structure_.value_count());
    hand_out({values_.get(), structure_.value_count()});
}

bool SupernodalFactor::factorize(std::span<const double> values) {
    make_room();
    return factorize(values, nullptr);
}

/// With a solve its forward half is done as well, panel by panel.
bool SupernodalFactor::factorize(std::span<const double> values, TriangularSolve<double>* solve) {
    workspaces_.resize(thread_count());
    narrow_ = false;
    std::atomic<bool> definite = true;
    parallel_for_workers(tree_.subtrees.size(), [&](std::size_t i, int worker) {
        const int subtree = static_cast<int>(i);
        for (const int s : tree_.subtrees[i].supernodes) {
            if (!definite.load(std::memory_order_relaxed)) return;
            if (!factor_alone(s, values, workspaces_[worker])) definite = false;
            if (definite && solve) solve->forward_in_subtree(subtree, s, worker);
        }
        if (definite && solve) solve->leave_subtree(subtree, worker);
    });
    if (!definite) return false;
    if (solve) solve->leave_subtrees();
    for (const int s : tree_.top) {
        if (!factor_together(s, values)) return false;
        if (solve) solve->forward_at_top(s);
    }
    return true;
}

bool SupernodalFactor::factorize_and_solve(std::span<const double> values, const Eigen::VectorXd& b,
                                           Eigen::VectorXd& x) {
    make_room();
    TriangularSolve<double> solve(structure_, tree_, values_.get(), b);
    if (!factorize(values, &solve)) return false;
    x = solve.backward();
    return true;
}

Eigen::MatrixXd SupernodalFactor::solve(const Eigen::MatrixXd& b) const {
    const auto solved = [&]<class Scalar>(Scalar) {
        TriangularSolve<Scalar> solve(structure_, tree_, values_.get(), b);
        solve.forward();
        return solve.backward();
    };
    return narrow_ ? solved(float()) : solved(double());
}

void SupernodalFactor::narrow() {
    if (narrow_) return;
    narrow_ = true;
    // In place, so with a detour: a piece is read before anything is written where it was.
    std::array<float, 256> rounded;
    const std::size_t length = structure_.value_count();
    const double* const from = values_.get();
    auto* const to = reinterpret_cast<std::byte*>(values_.get());
    for (std::size_t begin = 0; begin < length; begin += rounded.size()) {
        const std::size_t count = std::min(rounded.size(), length - begin);
        for (std::size_t k = 0; k < count; ++k) rounded[k] = static_cast<float>(from[begin + k]);
        std::memcpy(to + begin * sizeof(float), rounded.data(), count * sizeof(float));
    }
}

}  // namespace ruche
