#pragma once

#include <random>
#include <vector>

#include "energy/jet.hpp"
#include "ruche/energy/laminate_term.hpp"
#include "ruche/energy/model.hpp"

/// Meshes, states and elements with fixed seeds that the tests of the energy share.
namespace ruche::test {

/// nx x ny cells of 1 mm, inner vertices displaced at random by up to `jitter`, a random diagonal per cell;
/// vertices and triangles in random order.
TriangleMesh random_grid(int nx, int ny, double jitter, unsigned seed);

/// The layout scaled in its plane, rolled on a cylinder of the given radius, every position moved by up to
/// `noise` mm and every edge unknown set to up to `edge_noise` mm, turned in space.
struct Roll {
    double scale = 0.8;
    double radius = 4.0;
    double noise = 0.03;
    double edge_noise = 0.1;
    unsigned seed = 1;
    bool turned = true;
};
Eigen::VectorXd rolled(const Model& model, const Roll& roll);

/// A 5 x 4 grid on which every kind of edge occurs: bare-bare, bare-printed, printed-printed, boundary.
ModelInput patchwork();

/// A sheet of 16 x 16 cells with two strips across it, which cut the fabric into three pieces.
ModelInput two_strips();

/// The patchwork without print, with rods on the front and the back that cross, run side by side and bend.
ModelInput rod_patchwork();

/// Named variants of the patchwork: each option, print side, modulus, pre-stretch and load that the model
/// has.
struct SetUp {
    const char* name;
    ModelInput input;
    bool turns_freely = true;  ///< no gravity, no table: invariant under every rotation
};
std::vector<SetUp> set_ups();

/// One triangle and its three neighbours (vertices 0-2 and flaps 3-5, edge unknowns 6-8), as the layout and
/// in a random deformed shape.
struct Star {
    std::array<Vec2, 6> layout;
    Eigen::VectorXd x;
};
Star random_star(unsigned seed, double bend = 0.5);

/// The printed triangle of a star: two-sided, with the given kinds of edges.
enum class EdgeKind { free, averaged, free_rim, open_rim, clamped_rim };
LaminateTerm::Element laminate_element(const Star& star, const std::array<EdgeKind, 3>& kinds,
                                       const PrintedLaminate& print);
/// The same, its fabric ply with the fabric's own law.
LaminateTerm::Element with_fabric_law(LaminateTerm::Element element);
PrintedLaminate sample_print(bool front, bool back);

/// The first N entries of a state as jets.
template <int N>
std::vector<Jet<N>> jets(const Eigen::VectorXd& x) {
    std::vector<Jet<N>> result;
    for (int i = 0; i < N; ++i) result.push_back(Jet<N>::unknown(i, x[i]));
    return result;
}

}  // namespace ruche::test
