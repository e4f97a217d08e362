#include "ruche/statics/supernodal_structure.hpp"

#include <cholmod.h>

#include <new>

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
    }
    Analysis(const Analysis&) = delete;
    Analysis& operator=(const Analysis&) = delete;
    ~Analysis() {
        cholmod_free_factor(&factor, &common);
        cholmod_finish(&common);
    }
};

template <class Integer>
void copy(const void* first, std::size_t count, std::vector<Integer>& to) {
    const int* begin = static_cast<const int*>(first);
    to.assign(begin, begin + count);
}

}  // namespace

SupernodalStructure analyse(const SymmetricPattern& pattern, std::vector<int> elimination_order) {
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
    SupernodalStructure structure;
    copy(factor->super, factor->nsuper + 1, structure.first_column);
    copy(factor->pi, factor->nsuper + 1, structure.row_start);
    copy(factor->px, factor->nsuper + 1, structure.panel_start);
    copy(factor->s, factor->ssize, structure.rows);
    copy(factor->Perm, factor->n, structure.permutation);
    return structure;
}

}  // namespace ruche
