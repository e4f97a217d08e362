// What each part of the solver is worth: Newton's method from the flat print with the parts added one by one,
// until the product's own solve. Counts of iterations and factorisations, which do not depend on the machine.
//
//     step_alternatives [TRIANGLES] [SCENE...]      (default 5000, all scenes of `ruche bench` but the
//     drawing)
//
// Each row ends at a residual of 1e-6 N, or after 300 iterations ("-"). Energies tell whether it is the same
// shape.
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <string>
#include <vector>

#include "ruche/energy/model.hpp"
#include "ruche/scene/build.hpp"
#include "ruche/statics/equilibrium.hpp"
#include "ruche/statics/newton_system.hpp"
#include "ruche/statics/nonlinear_elimination.hpp"
#include "ruche/statics/retraction.hpp"
#include "ruche/statics/smoothing.hpp"
#include "ruche/statics/sparse_cholesky.hpp"
#include "ruche/statics/starts.hpp"
#include "ruche/study/benchmark_scene.hpp"

namespace ruche::bench {
namespace {

constexpr double tolerance = 1e-6;  // N
constexpr int most_iterations = 300;
constexpr double turning = 0.05;  // rad, rms

struct Variant {
    const char* name;
    bool along_retraction;       // else straight, no vertex farther than two elements
    bool first_gauss_newton;     // while a step turns the sheet by more than `turning`
    bool mean_where_indefinite;  // of both forms, else the Gauss-Newton form alone
    bool relaxed_spots;
    bool smoothed;  // before the first exact Hessian
};
constexpr Variant variants[] = {
    {"straight steps", false, false, false, false, false},
    {"+ retraction", true, false, false, false, false},
    {"+ Gauss-Newton while turning", true, true, false, false, false},
    {"+ mean where indefinite", true, true, true, false, false},
    {"+ relaxed spots", true, true, true, true, false},
    {"+ smoothing", true, true, true, true, true},
};

struct Outcome {
    bool converged = false;
    int iterations = 0;
    int factorizations = 0;
    double energy = 0.0;
};

class Trial {
  public:
    Trial(const Model& model, const Variant& variant)
        : model_(model),
          variant_(variant),
          held_(model.size(), 0),
          order_(vertex_elimination_order(model.pattern())),
          retraction_(model, order_),
          system_(model, held_, false, order_),
          elimination_(model, held_) {
        for (const Edge& edge : model.edges().edges) {
            const auto& layout = model.input().mesh.vertices;
            element_ = std::max(element_, (layout[edge.vertex[0]] - layout[edge.vertex[1]]).norm());
        }
    }

    Outcome run() {
        const SolveOptions options;
        x_ = noisy_start(model_, options.seed, options.noise_mm);
        Outcome outcome;
        bool moved = true;
        for (; outcome.iterations < most_iterations && moved; ++outcome.iterations) {
            const bool exact = !variant_.first_gauss_newton || rotation_ <= turning;
            energy_ = model_.evaluate(x_, exact ? Order::hessian : Order::gauss_newton, sums_).total();
            outcome.converged = sums_.gradient.cwiseAbs().maxCoeff() <= tolerance;
            if (outcome.converged || !find_step(exact)) break;
            rotation_ = retraction_.rms_rotation(x_, step_);
            moved = line_search(exact);
            if (variant_.smoothed && moved && !exact && rotation_ <= turning) smooth();
        }
        outcome.factorizations = system_.factorizations();
        outcome.energy = energy_;
        return outcome;
    }

  private:
    bool find_step(bool exact) {
        const NewtonPoint here{model_, x_, sums_};
        if (!exact) return system_.gauss_newton_step(here, step_);
        if (variant_.mean_where_indefinite) return system_.exact_step(here, rotation_, tolerance, step_);
        if (system_.certify(here)) return system_.exact_step(here, 0.0, tolerance, step_);
        AssembledSums form;
        model_.evaluate(x_, Order::gauss_newton, form);
        return system_.gauss_newton_step({model_, x_, form}, step_);
    }

    void smooth() {
        energy_ = model_.evaluate(x_, Order::hessian, sums_).total();
        step_ = smoothing_step(model_.pattern(), held_, sums_.hessian, sums_.gradient, smoothing_sweeps);
        if (step_.norm() > 0.0) (void)line_search(false);
    }

    Eigen::VectorXd at(double t) {
        return variant_.along_retraction ? retraction_(x_, step_, t) : Eigen::VectorXd(x_ + t * step_);
    }

    bool line_search(bool exact) {
        const double slope = sums_.gradient.dot(step_);
        const double before = sums_.gradient.cwiseAbs().maxCoeff();
        double t = 1.0;
        if (!variant_.along_retraction) {
            const auto positions = step_.head(3 * model_.vertex_count()).reshaped(3, model_.vertex_count());
            t = std::min(1.0, 2.0 * element_ / positions.colwise().norm().maxCoeff());
        }
        bool lower = false;
        bool halved = false;
        AssembledSums trial;
        Eigen::VectorXd candidate;
        for (int halving = 0; halving < 40 && !lower; ++halving, t *= 0.5) {
            candidate = at(t);
            const double energy = model_.evaluate(candidate, Order::gradient, trial).total();
            lower = energy <= energy_ + 1e-4 * t * slope;
            // Energy differences that drown in rounding.
            if (std::abs(slope) < 1e-9 * energy_) lower |= trial.gradient.cwiseAbs().maxCoeff() < before;
            halved |= !lower;
        }
        if (exact && variant_.mean_where_indefinite) system_.adapt(halved);
        if (!lower) return false;
        if (variant_.relaxed_spots && trial.gradient.cwiseAbs().maxCoeff() > 0.01 * before)
            elimination_(model_, candidate, trial.gradient, rotation_ <= turning ? 1 : 0);
        x_ = candidate;
        return true;
    }

    const Model& model_;
    const Variant variant_;
    std::vector<char> held_;
    std::vector<int> order_;
    Retraction retraction_;
    NewtonSystem system_;
    NonlinearElimination elimination_;
    double element_ = 0.0;
    Eigen::VectorXd x_, step_;
    AssembledSums sums_;
    double energy_ = 0.0;
    double rotation_ = infinity;
};

void print_row(const std::string& scene, int triangles, const char* name, const Outcome& outcome) {
    const std::string count =
        outcome.converged ? fmt::format("{} / {}", outcome.iterations, outcome.factorizations) : "-";
    fmt::print("| {} | {} | {} | {} | {:.7g} |\n", scene, triangles, name, count, outcome.energy);
    std::fflush(stdout);
}

void study(const std::string& scene_name, int triangles) {
    BenchmarkScene scene(scene_name);
    scene.resize(triangles);
    const PrintMesh layout = scene_mesh(scene.scene());
    const Model model(scene_model(scene.scene(), layout));
    const int count = layout.mesh.triangle_count();
    for (const Variant& variant : variants)
        print_row(scene_name, count, variant.name, Trial(model, variant).run());
    SolveOptions options;
    options.residual_tolerance_n = tolerance;
    const Equilibrium end = solve(model, options);
    print_row(scene_name, count, "ruche, from flat",
              {end.status == SolveStatus::converged, end.iterations, end.factorizations, end.energy.total()});
}

}  // namespace
}  // namespace ruche::bench

int main(int argc, char** argv) {
    const int triangles = argc > 1 ? std::atoi(argv[1]) : 5000;
    std::vector<std::string> scenes(argv + std::min(argc, 2), argv + argc);
    if (scenes.empty()) scenes = {"strips", "staggered", "torus", "stars"};
    fmt::print(
        "| scene | triangles | steps | iterations / factorisations | energy, mJ |\n|---|---|---|---|---|\n");
    for (const std::string& scene : scenes) ruche::bench::study(scene, triangles);
}
