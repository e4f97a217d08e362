#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <concepts>
#include <string_view>

#include "ruche/geometry/strain_measures.hpp"

namespace ruche {

/// How far to differentiate. `gauss_newton` fills the Hessian with a positive semidefinite part of it: the
/// material's tangent in strain space between first derivatives, no second derivatives of the strains.
class Order {
  public:
    static const Order value;
    static const Order gradient;
    static const Order hessian;
    static const Order gauss_newton;

    /// The weighted mean of the exact Hessian and the Gauss-Newton form, with this share of the latter.
    static constexpr Order mean(double gauss_newton_share) { return {2, gauss_newton_share}; }

    constexpr bool operator==(const Order&) const = default;
    constexpr bool wants_hessian() const { return derivatives_ == 2; }
    /// Of what the Gauss-Newton form leaves out, how much the Hessian has.
    constexpr double exact_share() const { return 1.0 - gauss_newton_share_; }
    constexpr double gauss_newton_share() const { return gauss_newton_share_; }

  private:
    constexpr Order(int derivatives, double gauss_newton_share)
        : derivatives_(derivatives), gauss_newton_share_(gauss_newton_share) {}

    int derivatives_;
    double gauss_newton_share_;
};

inline constexpr Order Order::value{0, 0.0};
inline constexpr Order Order::gradient{1, 0.0};
inline constexpr Order Order::hessian{2, 0.0};
inline constexpr Order Order::gauss_newton{2, 1.0};

/// Value, gradient and Hessian of one element, zero as far as `order` asks for them; the rest is left as it
/// is. Of the Hessian only the lower triangle (row >= column) counts, whatever stands above it.
template <int Size>
struct Local {
    double value = 0.0;
    Eigen::Matrix<double, Size, 1> gradient;
    Eigen::Matrix<double, Size, Size> hessian;

    explicit Local(Order order) {
        if (order != Order::value) gradient.setZero();
        if (order.wants_hessian()) hessian.setZero();
    }

    Eigen::Matrix<double, Size, Size> full_hessian() const {
        return hessian.template selfadjointView<Eigen::Lower>();
    }
};

/// Adds left right^T to the lower triangle of a matrix, by blocks of three: what falls above the diagonal in
/// a diagonal block does not matter.
template <int Size, class Matrix>
void add_lower_product(const Eigen::Matrix<double, Size, 1>& left,
                       const Eigen::Matrix<double, Size, 1>& right, Matrix& lower) {
    static_assert(Size % 3 == 0);
    for (int column = 0; column < Size; ++column) {
        for (int row = column - column % 3; row < Size; row += 3)
            lower.template block<3, 1>(row, column) += right[column] * left.template segment<3>(row);
    }
}

/// The unknowns as elements see them. Node v < vertex_count is a vertex (three unknowns); node vertex_count +
/// k is the k-th edge unknown (one).
struct Unknowns {
    const double* x = nullptr;
    int vertex_count = 0;

    Vec3 position(int vertex) const {
        return Eigen::Map<const Vec3>(x + 3 * static_cast<std::ptrdiff_t>(vertex));
    }
    double edge_unknown(int k) const { return x[3 * static_cast<std::ptrdiff_t>(vertex_count) + k]; }
};

/// A term of the energy: a sum over elements, each a function of a few nodes. `nodes(element)` lists first
/// the vertices, then the edge unknowns (by node number), -1 where an element has fewer; local unknowns
/// follow in that order, three per vertex and one per edge.
template <class T>
concept Term = requires(const T& term, int element, const Unknowns& x, Order order) {
    { T::name } -> std::convertible_to<std::string_view>;
    { T::vertex_slots } -> std::convertible_to<int>;
    { T::edge_slots } -> std::convertible_to<int>;
    { term.element_count() } -> std::same_as<int>;
    { term.nodes(element) } -> std::same_as<std::array<int, T::vertex_slots + T::edge_slots>>;
    { term.evaluate(element, x, order) } -> std::same_as<Local<3 * T::vertex_slots + T::edge_slots>>;
};

/// Adds slope * d2 L_i, the exact second derivative of the squared edge lengths of a triangle, to the lower
/// triangle of the first nine rows and columns of a local Hessian.
template <class Matrix>
void add_edge_length_curvature(const Vec3& slopes, Matrix& hessian) {
    for (int i = 0; i < 3; ++i) {
        const int p = 3 * std::max((i + 1) % 3, (i + 2) % 3);
        const int q = 3 * std::min((i + 1) % 3, (i + 2) % 3);
        for (int c = 0; c < 3; ++c) {
            hessian(p + c, p + c) += 2.0 * slopes[i];
            hessian(q + c, q + c) += 2.0 * slopes[i];
            hessian(p + c, q + c) -= 2.0 * slopes[i];
        }
    }
}

/// d L_i / d (v0, v1, v2), one row per edge.
inline Eigen::Matrix<double, 3, 9> edge_length_gradient(const Corners& v) {
    Eigen::Matrix<double, 3, 9> gradient = Eigen::Matrix<double, 3, 9>::Zero();
    for (int i = 0; i < 3; ++i) {
        const int p = (i + 1) % 3;
        const int q = (i + 2) % 3;
        const Vec3 d = 2.0 * (v[p] - v[q]);
        gradient.block<1, 3>(i, 3 * p) = d.transpose();
        gradient.block<1, 3>(i, 3 * q) = -d.transpose();
    }
    return gradient;
}

}  // namespace ruche
