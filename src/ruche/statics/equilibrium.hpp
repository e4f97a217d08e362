#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

#include "ruche/core/control.hpp"
#include "ruche/core/fields.hpp"
#include "ruche/energy/model.hpp"
#include "ruche/statics/transfer.hpp"

namespace ruche {

struct SolveOptions {
    double residual_tolerance_n = 1e-9;  ///< largest component of the gradient, N
    int max_iterations = 400;
    int seed = 1;                  ///< of the noise that breaks the flat state's symmetry
    double noise_mm = 1e-3;        ///< its size, limited to 1 % of the element size
    bool deterministic = true;     ///< the same bits at any thread count, which is always so
    int threads = 0;               ///< 0 = all cores
    bool coarse_start = true;      ///< simulate() solves on coarser meshes first
    double time_limit_s = 0.0;     ///< of simulate()'s release; 0 = none
    double memory_limit_mb = 0.0;  ///< of the whole process; 0 = what the machine and its limits allow
    /// Not an option of scenes: stop, without a certificate, when a step turns the sheet by less than this
    /// (root mean square, rad). For shapes that are only a start.
    double enough_rotation = 0.0;
    /// Neither: where the shape leans on the linear extension of the fabric's law, go on with this narrower
    /// one (model.log_extension); 0 = keep the model's.
    double narrow_log_extension = 0.0;
    /// Nor this: no step turns the sheet by more (root mean square, rad). A long step may leave the basin of
    /// a minimum; a search for other shapes takes short ones.
    double largest_turn = infinity;
};

template <>
std::span<const Field<SolveOptions>> fields<SolveOptions>();

enum class SolveStatus { converged, not_converged, interrupted };
std::string_view name_of(SolveStatus status);  ///< as the report has it: "not_converged"

/// What a solve on one mesh took.
struct LevelEffort {
    int triangles = 0;
    int iterations = 0;
    int factorizations = 0;
    std::vector<double> residuals;  ///< N, before each iteration and at the end
};

struct Equilibrium {
    Eigen::VectorXd x;  ///< all unknowns: positions row by row, then edge unknowns
    SolveStatus status = SolveStatus::not_converged;
    bool stable = false;  ///< strict local minimum: exact Hessian minus rigid motions has a Cholesky factor
    EnergyTerms energy;
    double residual = 0.0;       ///< largest component of the gradient over all free unknowns, N
    double typical_force = 0.0;  ///< to compare it with: rms over elements of the internal nodal force, N
    int iterations = 0;          ///< on this mesh
    int factorizations = 0;
    std::vector<double> residuals;    ///< N, before each iteration and at the end
    std::vector<LevelEffort> levels;  ///< from the coarsest mesh to this one
    double seconds = 0.0;             ///< of all levels
    double log_extension = 0.0;       ///< of the law that it is an equilibrium of
    Health health;
    std::string message;  ///< why it stopped, for a person
};

/// Finds a strict local minimum of the energy modulo the rigid motions that nothing resists: Newton's method
/// with the exact Hessian, the Gauss-Newton form while the sheet turns, steps along the rotation-strain
/// retraction, and the exact Cholesky factor as certificate; where that fails it leaves the saddle along the
/// direction of negative curvature. Starts from `start` (all unknowns) or from the flat printed state with a
/// little noise. Throws InputError for gravity that nothing holds, std::bad_alloc.
[[nodiscard]] Equilibrium solve(const Model& model, const SolveOptions& options = {},
                                const Control& control = {}, const Eigen::VectorXd* start = nullptr);

/// The same from the shape on another mesh of the layout. Where only a start for a finer mesh is wanted
/// (enough_rotation), tangles are left in it.
[[nodiscard]] Equilibrium solve(const Model& model, const SolveOptions& options, const Control& control,
                                const LayoutShape& start);

}  // namespace ruche
