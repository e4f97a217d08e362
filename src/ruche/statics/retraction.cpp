#include "ruche/statics/retraction.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <utility>

#include "ruche/core/parallel.hpp"

namespace ruche {
namespace {

using Edges = Eigen::Matrix<double, 3, 2>;

/// Spin and in-plane strain rate of a triangle under an edge increment.
struct ElementStep {
    Vec3 spin;      // axial vector of W
    Edges tangent;  // orthonormal basis of the triangle's plane
    Mat2 strain;    // eps in that basis
};

Edges edges_of(const Eigen::VectorXd& x, const Triangle& v) {
    const auto at = [&](int vertex) { return x.segment<3>(3 * static_cast<Eigen::Index>(vertex)); };
    Edges d;
    d << at(v[1]) - at(v[0]), at(v[2]) - at(v[0]);
    return d;
}

ElementStep element_step(const Edges& d, const Edges& dd) {
    ElementStep step;
    const Vec3 normal = d.col(0).cross(d.col(1)).normalized();
    const Mat2 metric = d.transpose() * d;
    const Edges p = d * metric.inverse();
    const Vec3 n_dot = -(p * (dd.transpose() * normal));
    const Mat3 a = dd * p.transpose() + n_dot * normal.transpose();
    step.spin = 0.5 * Vec3(a(2, 1) - a(1, 2), a(0, 2) - a(2, 0), a(1, 0) - a(0, 1));
    step.tangent.col(0) = d.col(0).normalized();
    step.tangent.col(1) = normal.cross(step.tangent.col(0));
    const Mat2 in_plane = step.tangent.transpose() * a * step.tangent;
    step.strain = 0.5 * (in_plane + in_plane.transpose());
    return step;
}

/// The square root of 1 + 2 t eps: squared lengths stay linear in t. Limits tame elements that a step would
/// crush or tear.
Mat2 stretch(const Mat2& strain, double t) {
    constexpr double least = 0.5;
    constexpr double most = 1.6;
    const Mat2 squared = Mat2::Identity() + 2.0 * t * strain;
    const double mean = 0.5 * squared.trace();
    const double radius = std::hypot(0.5 * (squared(0, 0) - squared(1, 1)), squared(0, 1));
    if (mean - radius > least * least && mean + radius < most * most) {
        const double area = std::sqrt(squared.determinant());
        return (squared + area * Mat2::Identity()) / std::sqrt(2.0 * (mean + area));  // by Cayley-Hamilton
    }
    Eigen::SelfAdjointEigenSolver<Mat2> eigen;
    eigen.computeDirect(squared);
    const Vec2 stretches = eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt().cwiseMax(least).cwiseMin(most);
    return eigen.eigenvectors() * stretches.asDiagonal() * eigen.eigenvectors().transpose();
}

/// D(t) - D.
Edges edge_change(const Edges& d, const ElementStep& step, double t) {
    const Edges strained = step.tangent * (stretch(step.strain, t) * (step.tangent.transpose() * d));
    const double angle = t * step.spin.norm();
    if (angle == 0.0) return strained - d;
    const Eigen::AngleAxisd rotation(angle, step.spin.normalized());
    return rotation.toRotationMatrix() * strained - d;
}

/// Triangles that are printed, or beside a rod.
std::vector<bool> held_by_plastic(const ModelInput& input) {
    std::set<std::pair<int, int>> rod_edges;
    for (const Rod& rod : input.rods) {
        for (std::size_t k = 0; k + 1 < rod.vertices.size(); ++k)
            rod_edges.insert(std::minmax(rod.vertices[k], rod.vertices[k + 1]));
    }
    std::vector<bool> held;
    for (std::size_t t = 0; t < input.mesh.triangles.size(); ++t) {
        const Triangle& v = input.mesh.triangles[t];
        const bool beside = rod_edges.contains(std::minmax(v[0], v[1])) ||
                            rod_edges.contains(std::minmax(v[1], v[2])) ||
                            rod_edges.contains(std::minmax(v[2], v[0]));
        held.push_back(!input.print[t].bare() || beside);
    }
    return held;
}

}  // namespace

Retraction::Retraction(const Model& model, std::vector<int> vertex_order)
    : vertex_count_(model.vertex_count()), order_(std::move(vertex_order)) {
    const ModelInput& input = model.input();
    const TriangleMesh& mesh = input.mesh;
    pieces_ = find_pieces(mesh);
    supports_ = input.supports;
    const std::vector<bool> stiff = held_by_plastic(input);
    for (int t = 0; t < mesh.triangle_count(); ++t) {
        const Triangle& v = mesh.triangles[t];
        Element element;
        element.vertices = v;
        element.area = layout_area(mesh, t);
        element.weight = element.area * (stiff[t] ? 30.0 : 1.0);
        Mat2 e;
        e << mesh.vertices[v[1]] - mesh.vertices[v[0]], mesh.vertices[v[2]] - mesh.vertices[v[0]];
        element.inverse_edges = e.inverse();
        element.gradients = hat_gradients(mesh, t);
        total_area_ += element.area;
        elements_.push_back(element);
    }

    NodePattern::Cliques cliques{.nodes = {}, .width = 3};
    for (const Element& e : elements_)
        cliques.nodes.insert(cliques.nodes.end(), e.vertices.begin(), e.vertices.end());
    // As edge unknowns the vertices are nodes of one unknown each.
    const NodePattern pattern(0, vertex_count_, std::span(&cliques, 1));
    column_start_ = pattern.column_start();
    row_index_ = pattern.row_index();
    values_.assign(row_index_.size(), 0.0);
    for (const Element& e : elements_) {
        for (int i = 0; i < 3; ++i) {
            for (int j = 0; j < 3; ++j) {
                if (e.vertices[i] < e.vertices[j]) continue;
                values_[pattern.block_offset(e.vertices[i], e.vertices[j])] +=
                    e.weight * e.gradients.col(i).dot(e.gradients.col(j));
            }
        }
    }
    if (order_.empty()) order_ = vertex_elimination_order(model.pattern());

    for (int c = 0; c < 3; ++c) {
        held_[c].assign(vertex_count_, 0);
        std::vector<char> piece_held(pieces_.count, 0);
        for (const Support& support : supports_) {
            if (!support.fixed[c]) continue;
            held_[c][support.vertex] = 1;
            if (pieces_.of_vertex[support.vertex] >= 0) piece_held[pieces_.of_vertex[support.vertex]] = 1;
        }
        dirichlet_[c] = held_[c];
        for (int v = 0; v < vertex_count_; ++v) {
            const int piece = pieces_.of_vertex[v];
            if (piece < 0) {
                dirichlet_[c][v] = 1;
            } else if (!piece_held[piece]) {
                piece_held[piece] = 1;
                anchors_[c].push_back(v);
                dirichlet_[c][v] = 1;
            }
        }
    }
}

SparseCholesky& Retraction::factor_without(int component) {
    if (factors_[component]) return *factors_[component];
    for (int c = 0; c < component; ++c) {
        if (factors_[c] && dirichlet_[c] == dirichlet_[component]) {
            factors_[component] = factors_[c];
            return *factors_[component];
        }
    }
    std::vector<double> values = values_;
    const std::vector<char>& fixed = dirichlet_[component];
    for (int column = 0; column < vertex_count_; ++column) {
        for (int k = column_start_[column]; k < column_start_[column + 1]; ++k) {
            if (fixed[column] || fixed[row_index_[k]]) values[k] = row_index_[k] == column ? 1.0 : 0.0;
        }
    }
    factors_[component] =
        std::make_shared<SparseCholesky>(SymmetricPattern{vertex_count_, column_start_, row_index_}, order_);
    if (!factors_[component]->factorize(values))
        throw std::runtime_error("the layout's Poisson matrix is singular");
    return *factors_[component];
}

Eigen::MatrixXd Retraction::weighted_divergence(const std::vector<Edges>& edge_changes) const {
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(vertex_count_, 3);
    for (std::size_t t = 0; t < elements_.size(); ++t) {
        const Element& e = elements_[t];
        const Mat3 pull = e.weight * (edge_changes[t] * e.inverse_edges) * e.gradients;
        for (int i = 0; i < 3; ++i) sum.row(e.vertices[i]) += pull.col(i).transpose();
    }
    return sum;
}

Eigen::MatrixXd Retraction::integrate(const std::vector<Edges>& edge_changes,
                                      const Eigen::VectorXd& mean_of) {
    Eigen::MatrixXd rhs = weighted_divergence(edge_changes);
    for (int c = 0; c < 3; ++c) {
        for (int v = 0; v < vertex_count_; ++v) {
            if (dirichlet_[c][v]) rhs(v, c) = 0.0;
        }
    }
    Eigen::MatrixXd moved(vertex_count_, 3);
    if (dirichlet_[0] == dirichlet_[1] && dirichlet_[1] == dirichlet_[2]) {
        moved = factor_without(0).solve(rhs);
    } else {
        for (int c = 0; c < 3; ++c) moved.col(c) = factor_without(c).solve(rhs.col(c));
    }
    for (int c = 0; c < 3; ++c) {
        std::vector<double> shift(pieces_.count, 0.0);
        std::vector<double> count(pieces_.count, 0.0);
        std::vector<char> loose(pieces_.count, 0);
        for (const int v : anchors_[c]) loose[pieces_.of_vertex[v]] = 1;
        for (int v = 0; v < vertex_count_; ++v) {
            const int piece = pieces_.of_vertex[v];
            if (piece < 0 || !loose[piece]) continue;
            shift[piece] += mean_of[3 * static_cast<Eigen::Index>(v) + c] - moved(v, c);
            count[piece] += 1.0;
        }
        for (int v = 0; v < vertex_count_; ++v) {
            const int piece = pieces_.of_vertex[v];
            if (piece < 0) {
                moved(v, c) = 0.0;
            } else if (loose[piece]) {
                moved(v, c) += shift[piece] / count[piece];
            }
        }
    }
    return moved;
}

template <class Body>
void Retraction::for_each_element(const Body& body) const {
    constexpr std::size_t chunk = 512;
    parallel_for((elements_.size() + chunk - 1) / chunk, [&](std::size_t block) {
        for (std::size_t i = block * chunk; i < std::min(elements_.size(), (block + 1) * chunk); ++i) body(i);
    });
}

Eigen::VectorXd Retraction::operator()(const Eigen::VectorXd& x, const Eigen::VectorXd& step, double t) {
    std::vector<Edges> change(elements_.size());
    for_each_element([&](std::size_t i) {
        const Edges d = edges_of(x, elements_[i].vertices);
        change[i] = edge_change(d, element_step(d, edges_of(step, elements_[i].vertices)), t);
    });
    const Eigen::Index positions = 3 * static_cast<Eigen::Index>(vertex_count_);
    const Eigen::MatrixXd moved = integrate(change, t * step.head(positions));
    Eigen::VectorXd result = x;
    for (int v = 0; v < vertex_count_; ++v)
        result.segment<3>(3 * static_cast<Eigen::Index>(v)) += moved.row(v).transpose();
    result.tail(x.size() - positions) += t * step.tail(x.size() - positions);
    return result;
}

Eigen::VectorXd Retraction::with_edges(const Eigen::VectorXd& x, const std::vector<Edges>& edges) {
    std::vector<Edges> change(elements_.size());
    for_each_element([&](std::size_t i) { change[i] = edges[i] - edges_of(x, elements_[i].vertices); });
    const Eigen::MatrixXd moved =
        integrate(change, Eigen::VectorXd::Zero(3 * static_cast<Eigen::Index>(vertex_count_)));
    Eigen::VectorXd result = x;
    for (int v = 0; v < vertex_count_; ++v)
        result.segment<3>(3 * static_cast<Eigen::Index>(v)) += moved.row(v).transpose();
    return result;
}

std::vector<Vec3> Retraction::spins(const Eigen::VectorXd& x, const Eigen::VectorXd& step) const {
    std::vector<Vec3> result(elements_.size());
    for_each_element([&](std::size_t i) {
        const Triangle& v = elements_[i].vertices;
        result[i] = element_step(edges_of(x, v), edges_of(step, v)).spin;
    });
    return result;
}

double Retraction::rms_rotation(const std::vector<Vec3>& spins) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < elements_.size(); ++i) sum += elements_[i].area * spins[i].squaredNorm();
    return std::sqrt(sum / total_area_);
}

Eigen::VectorXd Retraction::meet_supports(const Eigen::VectorXd& x) {
    Eigen::VectorXd result = x;
    for (int c = 0; c < 3; ++c) {
        Eigen::VectorXd target = Eigen::VectorXd::Zero(vertex_count_);
        for (const Support& support : supports_) {
            if (support.fixed[c])
                target[support.vertex] = support.at[c] - x[3 * static_cast<Eigen::Index>(support.vertex) + c];
        }
        if (target.isZero(0.0)) continue;
        // K u = 0 inside with u = target where held.
        Eigen::VectorXd rhs = Eigen::VectorXd::Zero(vertex_count_);
        for (int column = 0; column < vertex_count_; ++column) {
            for (int k = column_start_[column]; k < column_start_[column + 1]; ++k) {
                const int row = row_index_[k];
                rhs[row] -= values_[k] * target[column];
                if (row != column) rhs[column] -= values_[k] * target[row];
            }
        }
        for (int v = 0; v < vertex_count_; ++v) {
            if (dirichlet_[c][v]) rhs[v] = target[v];
        }
        const Eigen::VectorXd moved = factor_without(c).solve(rhs);
        for (int v = 0; v < vertex_count_; ++v) result[3 * static_cast<Eigen::Index>(v) + c] += moved[v];
    }
    return result;
}

}  // namespace ruche
