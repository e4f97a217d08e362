#pragma once

#include <array>
#include <tuple>
#include <vector>

#include "ruche/energy/term.hpp"
#include "ruche/geometry/pair_distance.hpp"

namespace ruche {

/// Two parts of the sheet that may touch.
struct ContactPair {
    PairKind kind = PairKind::vertex_triangle;
    std::array<int, 4> vertices = {-1, -1, -1, -1};
    double reach = 0.0;     ///< mm: at this distance they begin to repel each other
    double area = 0.0;      ///< mm^2 of layout that the pair stands for; negative where others count it twice
    double parallel = 0.0;  ///< mm^4, two edges: below this |u x v|^2 the repulsion fades out

    friend bool operator==(const ContactPair&, const ContactPair&) = default;
};

/// By vertices: neighbours in the mesh's order stay neighbours, which is good for the assembly.
inline bool in_order(const ContactPair& a, const ContactPair& b) {
    return std::tie(a.vertices, a.kind) < std::tie(b.vertices, b.kind);
}

/// Barrier between parts of the sheet that come close (Li et al., Incremental Potential Contact, ACM Trans.
/// Graph. 39, 2020; here b and u are without dimension):
///
///     W = k sum_pairs A m b(d^2 / reach^2),   b(u) = -(u - 1)^2 ln u for u < 1, else 0
///
/// twice continuously differentiable in u, infinite at contact. A sheet of area A at the distance d from
/// another is pressed with -k A db/dd; k is an energy per area, mJ/mm^2. For two edges with directions u, v
/// that are nearly parallel, whose closest points jump, m = c (2 - c), c = |u x v|^2 / `parallel` < 1 (their
/// mollifier); else m = 1. The Gauss-Newton form is k A m b'' grad(u) grad(u)^T; pairs of negative area,
/// which take back what others count twice, have none in it.
class ContactBarrier {
  public:
    static constexpr std::string_view name = "contact";
    static constexpr int vertex_slots = 4;
    static constexpr int edge_slots = 0;

    ContactBarrier(double stiffness, std::vector<ContactPair> pairs)
        : stiffness_(stiffness), pairs_(std::move(pairs)) {}

    const std::vector<ContactPair>& pairs() const { return pairs_; }

    int element_count() const { return static_cast<int>(pairs_.size()); }
    std::array<int, 4> nodes(int element) const { return pairs_[element].vertices; }
    Local<12> evaluate(int element, const Unknowns& x, Order order) const;

  private:
    double stiffness_;
    std::vector<ContactPair> pairs_;
};

/// Where the corners of a pair are; corners that it does not have are at the origin.
PairCorners corners(const ContactPair& pair, const Unknowns& x);

}  // namespace ruche
