#include "ruche/energy/sparsity.hpp"

#include <algorithm>
#include <type_traits>

namespace ruche {

NodePattern::NodePattern(int vertex_count, int edge_unknown_count, std::span<const Cliques> cliques)
    : vertex_count_(vertex_count) {
    const int nodes = vertex_count + edge_unknown_count;
    // Count, fill, sort and merge: for each column node the row nodes, duplicates removed at the end.
    const auto for_each_pair = [&](auto&& use) {
        for (const Cliques& group : cliques) {
            for (std::size_t start = 0; start < group.nodes.size(); start += group.width) {
                for (int i = 0; i < group.width; ++i) {
                    for (int j = 0; j < i; ++j) {
                        const int a = group.nodes[start + i];
                        const int b = group.nodes[start + j];
                        if (a >= 0 && b >= 0 && a != b) use(std::max(a, b), std::min(a, b));
                    }
                }
            }
        }
    };
    std::vector<std::size_t> begin(nodes + 1, 0);
    for (int n = 0; n < nodes; ++n) begin[n + 1] = 1;
    for_each_pair([&](int, int column) { ++begin[column + 1]; });
    for (int n = 0; n < nodes; ++n) begin[n + 1] += begin[n];
    std::vector<int> rows(begin[nodes]);
    std::vector<std::size_t> next(begin.begin(), begin.end() - 1);
    for (int n = 0; n < nodes; ++n) rows[next[n]++] = n;
    for_each_pair([&](int row, int column) { rows[next[column]++] = row; });

    row_start_.assign(nodes + 1, 0);
    column_length_.assign(nodes, 0);
    for (int n = 0; n < nodes; ++n) {
        const auto first = rows.begin() + static_cast<std::ptrdiff_t>(begin[n]);
        const auto last = rows.begin() + static_cast<std::ptrdiff_t>(begin[n + 1]);
        std::sort(first, last);
        row_nodes_.insert(row_nodes_.end(), first, std::unique(first, last));
        row_start_[n + 1] = static_cast<int>(row_nodes_.size());
        for (const int row : rows_of(n)) column_length_[n] += node_size(row);
    }

    const int unknowns = 3 * vertex_count + edge_unknown_count;
    column_start_.assign(unknowns + 1, 0);
    for (int n = 0; n < nodes; ++n) {
        for (int c = 0; c < node_size(n); ++c) column_start_[first_unknown(n) + c + 1] = column_length_[n];
    }
    for (int u = 0; u < unknowns; ++u) column_start_[u + 1] += column_start_[u];
    row_index_.resize(column_start_[unknowns]);
    for (int n = 0; n < nodes; ++n) {
        for (int c = 0; c < node_size(n); ++c) {
            int at = column_start_[first_unknown(n) + c];
            for (const int row : rows_of(n)) {
                for (int r = 0; r < node_size(row); ++r) row_index_[at++] = first_unknown(row) + r;
            }
        }
    }
}

int NodePattern::block_offset(int row_node, int column_node) const {
    const std::span<const int> rows = rows_of(column_node);
    const auto found = std::lower_bound(rows.begin(), rows.end(), row_node);
    int offset = column_start_[first_unknown(column_node)];
    // Vertex nodes come before edge unknowns, so the unknowns above the block follow from the counts.
    const int blocks_above = static_cast<int>(found - rows.begin());
    const int vertices_above =
        row_node < vertex_count_
            ? blocks_above
            : static_cast<int>(std::lower_bound(rows.begin(), rows.end(), vertex_count_) - rows.begin());
    offset += 3 * vertices_above + (blocks_above - vertices_above);
    return offset;
}

Eigen::SparseMatrix<double> NodePattern::full_matrix(std::span<const double> values) const {
    const int n = unknown_count();
    const Eigen::Map<const Eigen::SparseMatrix<double>> stored(
        n, n, static_cast<int>(values.size()), column_start_.data(), row_index_.data(), values.data());
    Eigen::SparseMatrix<double> full = stored.selfadjointView<Eigen::Lower>();
    full.makeCompressed();
    return full;
}

Eigen::VectorXd NodePattern::product(std::span<const double> values, const Eigen::VectorXd& x) const {
    Eigen::VectorXd y = Eigen::VectorXd::Zero(x.size());
    const auto add_columns = [&]<int Size>(std::integral_constant<int, Size>, int node) {
        const int first = first_unknown(node);
        const int length = column_length(node);
        const int* const row = row_index_.data() + column_start_[first];
        const double* const column = values.data() + column_start_[first];
        std::array<double, Size> own;
        std::array<double, Size> sum{};
        for (int c = 0; c < Size; ++c) own[c] = x[first + c];
        for (int c = 0; c < Size; ++c) {
            sum[c] += column[c + c * length] * own[c];
            for (int r = c + 1; r < Size; ++r) {
                sum[c] += column[r + c * length] * own[r];
                sum[r] += column[r + c * length] * own[c];
            }
        }
        for (int k = Size; k < length; ++k) {
            const double other = x[row[k]];
            double pull = 0.0;
            for (int c = 0; c < Size; ++c) {
                pull += column[k + c * length] * own[c];
                sum[c] += column[k + c * length] * other;
            }
            y[row[k]] += pull;
        }
        for (int c = 0; c < Size; ++c) y[first + c] += sum[c];
    };
    for (int node = 0; node < vertex_count_; ++node) add_columns(std::integral_constant<int, 3>(), node);
    for (int node = vertex_count_; node < node_count(); ++node)
        add_columns(std::integral_constant<int, 1>(), node);
    return y;
}

}  // namespace ruche
