#include "ruche/statics/smoothing.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <vector>

namespace ruche {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// The unknowns of a vertex.
template <class Vector>
auto at(Vector& x, int vertex) {
    return x.template segment<3>(3 * static_cast<Eigen::Index>(vertex));
}

/// A symmetric matrix H = L + D + L' with the diagonal blocks D of the nodes; rows and columns of nodes that
/// stay are left out.
class GaussSeidel {
  public:
    GaussSeidel(const NodePattern& pattern, std::span<const char> held, std::span<const double> values)
        : pattern_(pattern), vertices_(pattern.vertex_count()) {
        moves_.resize(pattern.node_count());
        blocks_.assign(vertices_, Matrix3d::Identity());
        inverse_blocks_.assign(vertices_, Matrix3d::Identity());
        edge_diagonal_.setOnes(pattern.node_count() - vertices_);
        lower_.reserve(values.size());
        for (int node = 0; node < pattern.node_count(); ++node) {
            const int first = pattern.first_unknown(node);
            const int size = pattern.node_size(node);
            const int length = pattern.column_length(node);
            const double* const column = values.data() + pattern.column_start()[first];
            for (int k = size; k < length; ++k) {
                for (int c = 0; c < size; ++c) lower_.push_back(static_cast<float>(column[k + c * length]));
            }
            const bool moves = std::none_of(held.begin() + first, held.begin() + first + size,
                                            [](char is_held) { return is_held != 0; });
            moves_[node] = moves ? 1 : 0;
            if (moves_[node] == 0) continue;
            if (node < vertices_) {
                const Eigen::Map<const Matrix3d, 0, Eigen::OuterStride<>> own(column,
                                                                              Eigen::OuterStride<>(length));
                blocks_[node] = own.selfadjointView<Eigen::Lower>();
                const Eigen::LLT<Matrix3d> factor(blocks_[node]);
                definite_ &= factor.info() == Eigen::Success;
                inverse_blocks_[node] = factor.solve(Matrix3d::Identity());
            } else {
                edge_diagonal_[node - vertices_] = *column;
                definite_ &= *column > 0.0;
            }
        }
    }

    /// Whether all diagonal blocks are positive definite.
    bool definite() const { return definite_; }

    /// D x
    void times_diagonal(const Eigen::VectorXd& x, Eigen::VectorXd& product) const {
        for (int v = 0; v < vertices_; ++v) at(product, v) = blocks_[v] * at(x, v);
        product.tail(edge_diagonal_.size()) = edge_diagonal_.cwiseProduct(x.tail(edge_diagonal_.size()));
    }

    /// x becomes (D + L)^-1 x, zero where nothing moves.
    void solve_lower(Eigen::VectorXd& x) const {
        const float* value = lower_.data();
        for (int v = 0; v < vertices_; ++v) {
            const Vector3d own = moves_[v] != 0 ? Vector3d(inverse_blocks_[v] * at(x, v)) : Vector3d::Zero();
            at(x, v) = own;
            const double own0 = own[0], own1 = own[1], own2 = own[2];
            for (const int row : rows_below(3 * v, 3)) {
                x[row] -= value[0] * own0 + value[1] * own1 + value[2] * own2;
                value += 3;
            }
        }
        for (int edge = 0; edge < edge_diagonal_.size(); ++edge) {
            const int unknown = 3 * vertices_ + edge;
            const double own = moves_[vertices_ + edge] != 0 ? x[unknown] / edge_diagonal_[edge] : 0.0;
            x[unknown] = own;
            for (const int row : rows_below(unknown, 1)) x[row] -= *value++ * own;
        }
    }

    /// x becomes (D + L')^-1 x, zero where nothing moves.
    void solve_upper(Eigen::VectorXd& x) const {
        const float* value = lower_.data() + lower_.size();
        for (int edge = static_cast<int>(edge_diagonal_.size()) - 1; edge >= 0; --edge) {
            const int unknown = 3 * vertices_ + edge;
            const std::span<const int> rows = rows_below(unknown, 1);
            double rest = x[unknown];
            for (std::size_t k = rows.size(); k-- > 0;) rest -= *--value * x[rows[k]];
            x[unknown] = moves_[vertices_ + edge] != 0 ? rest / edge_diagonal_[edge] : 0.0;
        }
        for (int v = vertices_ - 1; v >= 0; --v) {
            const std::span<const int> rows = rows_below(3 * v, 3);
            double pull0 = 0.0, pull1 = 0.0, pull2 = 0.0;
            for (std::size_t k = rows.size(); k-- > 0;) {
                const double other = x[rows[k]];
                value -= 3;
                pull0 += value[0] * other;
                pull1 += value[1] * other;
                pull2 += value[2] * other;
            }
            const Vector3d rest = at(x, v) - Vector3d(pull0, pull1, pull2);
            at(x, v) = moves_[v] != 0 ? Vector3d(inverse_blocks_[v] * rest) : Vector3d::Zero();
        }
    }

  private:
    /// Rows below the diagonal block of the node of this first unknown, which has `size` of them.
    std::span<const int> rows_below(int unknown, int size) const {
        const int* const row = pattern_.row_index().data();
        return {row + pattern_.column_start()[unknown] + size, row + pattern_.column_start()[unknown + 1]};
    }

    const NodePattern& pattern_;
    int vertices_;
    std::vector<char> moves_;  // per node
    // L by columns of nodes, row by row; reading it takes nearly all the time, and a direction needs no
    // digits.
    std::vector<float> lower_;
    std::vector<Matrix3d> blocks_;
    std::vector<Matrix3d> inverse_blocks_;
    Eigen::VectorXd edge_diagonal_;
    bool definite_ = true;
};

}  // namespace

Eigen::VectorXd smoothing_step(const NodePattern& pattern, std::span<const char> held,
                               std::span<const double> hessian, const Eigen::VectorXd& gradient, int sweeps) {
    Eigen::VectorXd step = Eigen::VectorXd::Zero(gradient.size());
    const GaussSeidel matrix(pattern, held, hessian);
    if (!matrix.definite()) return step;
    // Conjugate gradients for (D+L)^-1 H (D+L')^-1, preconditioned by D^-1; H = (D+L) + (D+L') - D.
    Eigen::VectorXd rest = -gradient;
    matrix.solve_lower(rest);
    Eigen::VectorXd weighed(rest.size());
    matrix.times_diagonal(rest, weighed);
    Eigen::VectorXd direction = weighed;
    Eigen::VectorXd move(rest.size());
    Eigen::VectorXd pull(rest.size());
    double product = rest.dot(direction);
    for (int sweep = 0; sweep < sweeps && product > 0.0; ++sweep) {
        move = direction;
        matrix.solve_upper(move);
        matrix.times_diagonal(move, weighed);
        pull = direction - weighed;
        matrix.solve_lower(pull);
        pull += move;
        const double curvature = direction.dot(pull);
        if (!(curvature > 0.0)) break;
        step += (product / curvature) * move;
        rest -= (product / curvature) * pull;
        matrix.times_diagonal(rest, weighed);
        const double next_product = rest.dot(weighed);
        direction = weighed + (next_product / product) * direction;
        product = next_product;
    }
    return step;
}

}  // namespace ruche
