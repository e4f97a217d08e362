#include "ruche/statics/supernodal_structure.hpp"

#include <cholmod.h>

#include <new>
#include <numeric>

namespace ruche {
namespace {

/// CHOLMOD's workspace and the factor whose structure is looked for.
struct Analysis {
    cholmod_common common{};
    cholmod_factor* factor = nullptr;

    Analysis() {
        cholmod_start(&common);
        common.print = 0;
        common.nmethods = 1;
        common.method[0].ordering = CHOLMOD_GIVEN;
        common.postorder = 1;
        common.supernodal = CHOLMOD_SUPERNODAL;
        // CHOLMOD merges supernodes of up to so many columns; here they are nodes of up to three unknowns.
        for (std::size_t& columns : common.nrelax) columns = (columns + 2) / 3;
    }
    Analysis(const Analysis&) = delete;
    Analysis& operator=(const Analysis&) = delete;
    ~Analysis() {
        cholmod_free_factor(&factor, &common);
        cholmod_finish(&common);
    }
};

std::span<const int> integers(const void* first, std::size_t count) {
    return {static_cast<const int*>(first), count};
}

/// From nodes to their unknowns.
SupernodalStructure of_unknowns(const cholmod_factor& factor, std::span<const int> sizes) {
    const std::span<const int> order = integers(factor.Perm, factor.n);
    std::vector<int> first_unknown(sizes.size() + 1, 0);
    std::partial_sum(sizes.begin(), sizes.end(), first_unknown.begin() + 1);
    SupernodalStructure structure;
    structure.permutation.reserve(first_unknown.back());
    std::vector<int> eliminated_at = {0};  // the first unknown of the node that is eliminated k-th
    eliminated_at.reserve(order.size() + 1);
    for (const int node : order) {
        for (int u = first_unknown[node]; u < first_unknown[node + 1]; ++u)
            structure.permutation.push_back(u);
        eliminated_at.push_back(static_cast<int>(structure.permutation.size()));
    }

    const std::span<const int> first_node = integers(factor.super, factor.nsuper + 1);
    const std::span<const int> row_start = integers(factor.pi, factor.nsuper + 1);
    const std::span<const int> row_nodes = integers(factor.s, factor.ssize);
    structure.row_start = {0};
    structure.panel_start = {0};
    for (const int node : first_node) structure.first_column.push_back(eliminated_at[node]);
    for (std::size_t s = 0; s < factor.nsuper; ++s) {
        for (const int node : row_nodes.subspan(row_start[s], row_start[s + 1] - row_start[s])) {
            for (int u = eliminated_at[node]; u < eliminated_at[node + 1]; ++u) structure.rows.push_back(u);
        }
        structure.row_start.push_back(static_cast<int>(structure.rows.size()));
        const int supernode = static_cast<int>(s);
        structure.panel_start.push_back(structure.panel_start.back() +
                                        static_cast<std::size_t>(structure.columns(supernode)) *
                                            structure.panel_rows(supernode));
    }
    return structure;
}

}  // namespace

SupernodalStructure analyse(const NodeGraph& graph, std::vector<int> elimination_order) {
    const SymmetricPattern& pattern = graph.nodes;
    cholmod_sparse matrix{};
    matrix.nrow = matrix.ncol = static_cast<std::size_t>(pattern.size);
    matrix.nzmax = pattern.row_index.size();
    // CHOLMOD's interface has no const; it only reads.
    matrix.p = const_cast<int*>(pattern.column_start.data());
    matrix.i = const_cast<int*>(pattern.row_index.data());
    matrix.stype = -1;
    matrix.itype = CHOLMOD_INT;
    matrix.xtype = CHOLMOD_PATTERN;
    matrix.dtype = CHOLMOD_DOUBLE;
    matrix.sorted = 1;
    matrix.packed = 1;

    Analysis analysis;
    analysis.factor = cholmod_analyze_p(&matrix, elimination_order.data(), nullptr, 0, &analysis.common);
    const cholmod_factor* factor = analysis.factor;
    if (factor == nullptr || analysis.common.status != CHOLMOD_OK) throw std::bad_alloc();
    return of_unknowns(*factor, graph.sizes);
}

}  // namespace ruche
