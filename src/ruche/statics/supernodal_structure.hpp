#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace ruche {

/// The lower triangle of a symmetric matrix in compressed columns, rows ascending; entries above the diagonal
/// are ignored. Only the structure: values come with each factorisation.
struct SymmetricPattern {
    int size = 0;
    std::span<const int> column_start;
    std::span<const int> row_index;
};

/// A symmetric matrix made of dense blocks between nodes. The unknowns of a node follow those of the node
/// before.
struct NodeGraph {
    SymmetricPattern nodes;      ///< between which nodes there are blocks
    std::span<const int> sizes;  ///< unknowns of each node
};

/// The structure of a Cholesky factor whose columns are gathered in supernodes, groups of columns with the
/// same rows. Supernode s has the columns [first_column[s], first_column[s + 1]) and the rows
/// rows[row_start[s]] ..< rows[row_start[s + 1]], ascending, its own columns first; its values are a dense
/// column-major panel that begins at panel_start[s]. Columns and rows are numbered in the order of
/// elimination.
struct SupernodalStructure {
    std::vector<int> first_column;
    std::vector<int> row_start;
    std::vector<std::size_t> panel_start;
    std::vector<int> rows;
    std::vector<int> permutation;  ///< the unknown that is eliminated k-th

    int size() const { return static_cast<int>(permutation.size()); }
    int supernode_count() const { return static_cast<int>(first_column.size()) - 1; }
    int columns(int s) const { return first_column[s + 1] - first_column[s]; }
    int panel_rows(int s) const { return row_start[s + 1] - row_start[s]; }
    const int* panel_row(int s) const { return rows.data() + row_start[s]; }
    std::size_t value_count() const { return panel_start.back(); }
};

/// The elimination tree, cut: subtrees that do not touch each other, none with more than a small share of the
/// work, and the supernodes above them.
struct TreeSplit {
    struct Subtree {
        std::vector<int> supernodes;  ///< in order of elimination, the root last
        double work = 0.0;
    };
    std::vector<Subtree> subtrees;  ///< the one with most work first
    std::vector<int> top;           ///< in order of elimination
};

/// Symbolic analysis (CHOLMOD, of the graph of the nodes): the structure of the factor when node
/// `elimination_order[k]` is eliminated k-th, up to exchanges that leave the fill as it is. Throws
/// std::bad_alloc.
SupernodalStructure analyse(const NodeGraph& graph, std::vector<int> elimination_order);

}  // namespace ruche
