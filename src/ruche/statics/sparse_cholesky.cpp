#include "ruche/statics/sparse_cholesky.hpp"

#include <cholmod.h>
#include <metis.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <new>
#include <numeric>

extern "C" void openblas_set_num_threads(int threads);

namespace ruche {
namespace {

std::atomic<int> blas_threads = 1;

}  // namespace

void set_blas_threads(int count) { blas_threads = std::max(1, count); }

struct SparseCholesky::Factor {
    cholmod_common common{};
    cholmod_factor* numeric = nullptr;
    cholmod_dense* solution = nullptr;
    cholmod_dense* work_y = nullptr;
    cholmod_dense* work_e = nullptr;
    int size = 0;
    std::vector<int> column_start;
    std::vector<int> row_index;

    Factor() {
        cholmod_start(&common);
        common.print = 0;
        common.nmethods = 1;
        common.method[0].ordering = CHOLMOD_GIVEN;
        common.postorder = 1;
        common.supernodal = CHOLMOD_SUPERNODAL;
        common.final_ll = 1;
        common.quick_return_if_not_posdef = 1;
        openblas_set_num_threads(blas_threads);
    }
    Factor(const Factor&) = delete;
    Factor& operator=(const Factor&) = delete;
    ~Factor() {
        cholmod_free_dense(&solution, &common);
        cholmod_free_dense(&work_y, &common);
        cholmod_free_dense(&work_e, &common);
        cholmod_free_factor(&numeric, &common);
        cholmod_finish(&common);
    }

    cholmod_sparse matrix(const double* values) {
        cholmod_sparse a{};
        a.nrow = size;
        a.ncol = size;
        a.nzmax = row_index.size();
        a.p = column_start.data();
        a.i = row_index.data();
        a.x = const_cast<double*>(values);  // CHOLMOD's interface has no const; it only reads
        a.stype = -1;
        a.itype = CHOLMOD_INT;
        a.xtype = values != nullptr ? CHOLMOD_REAL : CHOLMOD_PATTERN;
        a.dtype = CHOLMOD_DOUBLE;
        a.sorted = 1;
        a.packed = 1;
        return a;
    }

    void require_success() const {
        if (common.status == CHOLMOD_OUT_OF_MEMORY || common.status == CHOLMOD_TOO_LARGE)
            throw std::bad_alloc();
    }
};

SparseCholesky::SparseCholesky(const SymmetricPattern& pattern, std::vector<int> order)
    : factor_(std::make_unique<Factor>()) {
    factor_->size = pattern.size;
    factor_->column_start.assign(pattern.column_start.begin(), pattern.column_start.end());
    factor_->row_index.assign(pattern.row_index.begin(), pattern.row_index.end());
    cholmod_sparse a = factor_->matrix(nullptr);
    factor_->numeric = cholmod_analyze_p(&a, order.data(), nullptr, 0, &factor_->common);
    factor_->require_success();
    if (factor_->numeric == nullptr) throw std::bad_alloc();
}

SparseCholesky::~SparseCholesky() = default;
SparseCholesky::SparseCholesky(SparseCholesky&&) noexcept = default;
SparseCholesky& SparseCholesky::operator=(SparseCholesky&&) noexcept = default;

bool SparseCholesky::factorize(std::span<const double> values) {
    cholmod_sparse a = factor_->matrix(values.data());
    const int ok = cholmod_factorize(&a, factor_->numeric, &factor_->common);
    factor_->require_success();
    if (ok == 0 || factor_->common.status == CHOLMOD_NOT_POSDEF ||
        factor_->numeric->minor < static_cast<std::size_t>(factor_->size)) {
        return false;
    }
    // LAPACK lets NaN pass the test for a positive pivot; the factor's reciprocal condition shows it.
    const double condition = cholmod_rcond(factor_->numeric, &factor_->common);
    return std::isfinite(condition) && condition > 0.0;
}

Eigen::MatrixXd SparseCholesky::solve(const Eigen::MatrixXd& right_hand_side) {
    cholmod_dense b{};
    b.nrow = static_cast<std::size_t>(right_hand_side.rows());
    b.ncol = static_cast<std::size_t>(right_hand_side.cols());
    b.nzmax = b.nrow * b.ncol;
    b.d = b.nrow;
    b.x = const_cast<double*>(right_hand_side.data());
    b.xtype = CHOLMOD_REAL;
    b.dtype = CHOLMOD_DOUBLE;
    cholmod_solve2(CHOLMOD_A, factor_->numeric, &b, nullptr, &factor_->solution, nullptr, &factor_->work_y,
                   &factor_->work_e, &factor_->common);
    factor_->require_success();
    const auto* values = static_cast<const double*>(factor_->solution->x);
    return Eigen::Map<const Eigen::MatrixXd>(values, right_hand_side.rows(), right_hand_side.cols());
}

double SparseCholesky::factor_megabytes() const {
    return static_cast<double>(factor_->numeric->xsize) * sizeof(double) / 1e6;
}

std::vector<int> nested_dissection(std::span<const int> start, std::span<const int> neighbours) {
    static_assert(sizeof(idx_t) == sizeof(int), "METIS with 32-bit indices");
    idx_t count = static_cast<idx_t>(start.size()) - 1;
    std::vector<int> order(count);
    std::iota(order.begin(), order.end(), 0);
    if (neighbours.empty()) return order;
    std::vector<idx_t> xadj(start.begin(), start.end());
    std::vector<idx_t> adjncy(neighbours.begin(), neighbours.end());
    std::vector<idx_t> position(count);
    idx_t options[METIS_NOPTIONS];
    METIS_SetDefaultOptions(options);
    options[METIS_OPTION_SEED] = 1;
    options[METIS_OPTION_NUMBERING] = 0;
    if (METIS_NodeND(&count, xadj.data(), adjncy.data(), nullptr, options, order.data(), position.data()) !=
        METIS_OK) {
        throw std::bad_alloc();
    }
    return order;
}

std::vector<int> vertex_elimination_order(const NodePattern& pattern) {
    const int vertices = pattern.vertex_count();
    std::vector<int> start(vertices + 1, 0);
    const auto for_each_pair = [&](auto&& use) {
        for (int column = 0; column < vertices; ++column) {
            for (const int row : pattern.rows_of(column)) {
                if (row > column && row < vertices) use(row, column);
            }
        }
    };
    for_each_pair([&](int row, int column) { ++start[row + 1], ++start[column + 1]; });
    std::partial_sum(start.begin(), start.end(), start.begin());
    std::vector<int> neighbours(start.back());
    std::vector<int> next(start.begin(), start.end() - 1);
    for_each_pair(
        [&](int row, int column) { neighbours[next[row]++] = column, neighbours[next[column]++] = row; });
    return nested_dissection(start, neighbours);
}

std::vector<int> elimination_order(const Model& model, std::span<const int> vertex_order) {
    const NodePattern& pattern = model.pattern();
    const int vertices = pattern.vertex_count();
    std::vector<int> rank(vertices);
    for (int k = 0; k < vertices; ++k) rank[vertex_order[k]] = k;
    std::vector<std::vector<int>> unknowns_before(vertices);
    for (int k = 0; k < pattern.node_count() - vertices; ++k) {
        const std::array<int, 4> around = model.vertices_of_edge_unknown(k);
        const int first =
            *std::min_element(around.begin(), around.end(), [&](int a, int b) { return rank[a] < rank[b]; });
        unknowns_before[first].push_back(pattern.first_unknown(vertices + k));
    }
    std::vector<int> order;
    order.reserve(pattern.unknown_count());
    for (const int v : vertex_order) {
        order.insert(order.end(), unknowns_before[v].begin(), unknowns_before[v].end());
        for (int c = 0; c < 3; ++c) order.push_back(3 * v + c);
    }
    return order;
}

}  // namespace ruche
