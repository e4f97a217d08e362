#include "ruche/statics/triangular_solve.hpp"

#include <cblas.h>

#include <algorithm>

#include "ruche/core/parallel.hpp"

namespace ruche {
namespace {

/// x <- L^-1 x, or L^-T x.
void solve_triangle(CBLAS_TRANSPOSE transpose, int size, const double* l, int stride, double* x) {
    cblas_dtrsv(CblasColMajor, CblasLower, transpose, CblasNonUnit, size, l, stride, x, 1);
}
void solve_triangle(CBLAS_TRANSPOSE transpose, int size, const float* l, int stride, float* x) {
    cblas_strsv(CblasColMajor, CblasLower, transpose, CblasNonUnit, size, l, stride, x, 1);
}

struct Shape {
    int rows, columns, stride;
};

/// y <- scale A x + keep y, or that with A^T.
void multiply(CBLAS_TRANSPOSE transpose, const Shape& shape, double scale, const double* a, const double* x,
              double keep, double* y) {
    cblas_dgemv(CblasColMajor, transpose, shape.rows, shape.columns, scale, a, shape.stride, x, 1, keep, y,
                1);
}
void multiply(CBLAS_TRANSPOSE transpose, const Shape& shape, float scale, const float* a, const float* x,
              float keep, float* y) {
    cblas_sgemv(CblasColMajor, transpose, shape.rows, shape.columns, scale, a, shape.stride, x, 1, keep, y,
                1);
}

}  // namespace

template <class Scalar>
TriangularSolve<Scalar>::TriangularSolve(const SupernodalStructure& structure, const TreeSplit& tree,
                                         const double* values, const Eigen::MatrixXd& b)
    : structure_(structure),
      tree_(tree),
      values_(values),
      y_(b.rows(), b.cols()),
      gathered_(thread_count()),
      outside_(thread_count()),
      shares_(tree.subtrees.size()) {
    for (Eigen::Index k = 0; k < b.rows(); ++k)
        y_.row(k) = b.row(structure.permutation[k]).template cast<Scalar>();
}

template <class Scalar>
typename TriangularSolve<Scalar>::Panel TriangularSolve<Scalar>::panel(int s) const {
    const int columns = structure_.columns(s);
    const int stride = structure_.panel_rows(s);
    return {reinterpret_cast<const Scalar*>(values_) + structure_.panel_start[s], columns, stride,
            stride - columns, structure_.panel_row(s) + columns};
}

/// Asks for the beginning of a panel, to be worked on next. Panels are too short for the processor to notice
/// by itself that it reads on and on.
template <class Scalar>
void TriangularSolve<Scalar>::fetch(int s) const {
    constexpr std::size_t most = 65'536;  // bytes
    constexpr std::size_t line = 64;
    if (s < 0 || s >= structure_.supernode_count()) return;
    const Panel next = panel(s);
    const std::size_t size = sizeof(Scalar) * next.columns * next.stride;
    const char* const begin = reinterpret_cast<const char*>(next.values);
    for (std::size_t at = 0; at < std::min(most, size); at += line) __builtin_prefetch(begin + at, 0, 2);
    asm volatile("");  // GCC 12 drops calls of a function that does nothing but fetch
}

template <class Scalar>
std::span<const int> TriangularSolve<Scalar>::rows_above(int subtree) const {
    const int root = tree_.subtrees[subtree].supernodes.back();
    return std::span(structure_.panel_row(root), structure_.panel_rows(root))
        .subspan(structure_.columns(root));
}

template <class Scalar>
void TriangularSolve<Scalar>::forward_in_subtree(int subtree, int supernode, int worker) {
    if (outside_[worker].size() == 0) outside_[worker] = Matrix::Zero(y_.rows(), y_.cols());
    const int root = tree_.subtrees[subtree].supernodes.back();
    forward(supernode, structure_.first_column[root + 1] - 1, worker);
}

template <class Scalar>
void TriangularSolve<Scalar>::leave_subtree(int subtree, int worker) {
    const std::span<const int> above = rows_above(subtree);
    Matrix& share = shares_[subtree];
    share.resize(static_cast<Eigen::Index>(above.size()), y_.cols());
    for (std::size_t r = 0; r < above.size(); ++r) {
        share.row(static_cast<Eigen::Index>(r)) = outside_[worker].row(above[r]);
        outside_[worker].row(above[r]).setZero();
    }
}

template <class Scalar>
void TriangularSolve<Scalar>::leave_subtrees() {
    for (std::size_t i = 0; i < shares_.size(); ++i) {
        const std::span<const int> above = rows_above(static_cast<int>(i));
        for (std::size_t r = 0; r < above.size(); ++r)
            y_.row(above[r]) += shares_[i].row(static_cast<Eigen::Index>(r));
    }
}

/// y_s <- L_ss^-1 y_s, and what that takes from the rows below: those up to `last_inside` in y itself, those
/// above it in the worker's `outside`.
template <class Scalar>
void TriangularSolve<Scalar>::forward(int s, int last_inside, int worker) {
    const auto [values, columns, stride, below, rows] = panel(s);
    Matrix& gathered = gathered_[worker];
    gathered.resize(below, 1);
    // Column by column: matrix kernels would copy the whole panel first, for a few right-hand sides.
    for (Eigen::Index c = 0; c < y_.cols(); ++c) {
        Scalar* const own = y_.col(c).data() + structure_.first_column[s];
        solve_triangle(CblasNoTrans, columns, values, stride, own);
        if (below == 0) continue;
        multiply(CblasNoTrans, {below, columns, stride}, 1, values + columns, own, 0, gathered.data());
        for (int r = 0; r < below; ++r) {
            Matrix& to = rows[r] <= last_inside ? y_ : outside_[worker];
            to(rows[r], c) -= gathered(r, 0);
        }
    }
}

/// y_s <- L_ss^-T (y_s - L_below^T y_below).
template <class Scalar>
void TriangularSolve<Scalar>::backward(int s, int worker) {
    const auto [values, columns, stride, below, rows] = panel(s);
    Matrix& gathered = gathered_[worker];
    gathered.resize(below, 1);
    fetch(s - 1);
    for (Eigen::Index c = 0; c < y_.cols(); ++c) {
        Scalar* const own = y_.col(c).data() + structure_.first_column[s];
        for (int r = 0; r < below; ++r) gathered(r, 0) = y_(rows[r], c);
        if (below > 0) {
            multiply(CblasTrans, {below, columns, stride}, -1, values + columns, gathered.data(), 1, own);
        }
        solve_triangle(CblasTrans, columns, values, stride, own);
    }
}

template <class Scalar>
void TriangularSolve<Scalar>::forward() {
    parallel_for_workers(tree_.subtrees.size(), [&](std::size_t i, int worker) {
        const int subtree = static_cast<int>(i);
        for (const int s : tree_.subtrees[i].supernodes) {
            fetch(s + 1);
            forward_in_subtree(subtree, s, worker);
        }
        leave_subtree(subtree, worker);
    });
    leave_subtrees();
    for (const int s : tree_.top) {
        fetch(s + 1);
        forward_at_top(s);
    }
}

template <class Scalar>
Eigen::MatrixXd TriangularSolve<Scalar>::backward() {
    for (std::size_t i = tree_.top.size(); i-- > 0;) backward(tree_.top[i], 0);
    parallel_for_workers(tree_.subtrees.size(), [&](std::size_t i, int worker) {
        const std::vector<int>& supernodes = tree_.subtrees[i].supernodes;
        for (std::size_t k = supernodes.size(); k-- > 0;) backward(supernodes[k], worker);
    });
    Eigen::MatrixXd x(y_.rows(), y_.cols());
    for (Eigen::Index k = 0; k < x.rows(); ++k)
        x.row(structure_.permutation[k]) = y_.row(k).template cast<double>();
    return x;
}

template class TriangularSolve<double>;
template class TriangularSolve<float>;

}  // namespace ruche
