#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "ruche/core/control.hpp"
#include "ruche/core/fields.hpp"
#include "ruche/energy/model.hpp"

namespace ruche {

struct SolveOptions {
    double residual_tolerance_n = 1e-9;  ///< largest component of the gradient, N
    int max_iterations = 400;
    int seed = 1;               ///< of the noise that breaks the flat state's symmetry
    double noise_mm = 1e-3;     ///< its size, limited to 1 % of the element size
    bool deterministic = true;  ///< same bits at any thread count
    int threads = 0;            ///< 0 = all cores
};

template <>
std::span<const Field<SolveOptions>> fields<SolveOptions>();

struct EnergyTerms {
    double fabric_membrane = 0.0;  ///< mJ
    double fabric_bending = 0.0;
    double plastic = 0.0;  ///< the whole laminate, its fabric ply included
    double gravity = 0.0;  ///< with dead forces and the table's reaction potential
    double total() const { return fabric_membrane + fabric_bending + plastic + gravity; }
};

/// What a careful reader of a result has to know.
struct Health {
    double max_strain_margin = 0.0;  ///< max over bare fabric of E_ii - gamma_i (negative: inside the law)
    double min_area_ratio = 1.0;     ///< smallest current / relaxed-fabric area ratio J
    double max_dihedral_deg = 0.0;
    double max_edge_rotation_deg = 0.0;  ///< max |theta/2 +- xi|, must stay below 90
    int beyond_law = 0;                  ///< elements in the law's linear extension
    int self_intersections = 0;          ///< pairs of triangles that pass through each other
};

enum class SolveStatus { converged, not_converged, interrupted };

struct Equilibrium {
    Eigen::VectorXd x;  ///< all unknowns: positions row by row, then edge unknowns
    SolveStatus status = SolveStatus::not_converged;
    bool stable = false;  ///< strict local minimum: exact Hessian minus rigid motions has a Cholesky factor
    EnergyTerms energy;
    double residual = 0.0;       ///< largest component of the gradient over all free unknowns, N
    double typical_force = 0.0;  ///< to compare it with: rms over elements of the internal nodal force, N
    int iterations = 0;
    int factorizations = 0;
    double seconds = 0.0;
    Health health;
    std::string message;  ///< why it stopped, for a person
};

}  // namespace ruche
