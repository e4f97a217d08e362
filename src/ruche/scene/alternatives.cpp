#include "ruche/scene/alternatives.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "ruche/geometry/layout_frame.hpp"
#include "ruche/statics/shape_catalogue.hpp"
#include "ruche/statics/starts.hpp"

namespace ruche {
namespace {

constexpr double pi = std::numbers::pi;

struct StartTried {
    std::string name;
    Eigen::VectorXd x;
};

/// The starts of a search, one after the other.
class Starts {
  public:
    Starts(const Model& model, const Scene& scene, int wanted)
        : model_(model), seed_(scene.solver.seed), noise_(scene.solver.noise_mm), waves_(6 * wanted) {
        const double longest = layout_frame(model.input().mesh).longest;
        for (const double turn : {pi, -pi, 3.0 * pi}) {
            for (const double from_longest : {0.5 * pi, 0.0, 0.25 * pi, -0.25 * pi})
                rolls_.push_back({.direction = longest + from_longest, .turn = turn});
        }
    }

    int count() const { return static_cast<int>(rolls_.size()) + waves_; }

    StartTried operator[](int i) const {
        StartTried start;
        if (i < static_cast<int>(rolls_.size())) {
            const Roll& roll = rolls_[i];
            start = {fmt::format("rolled by {:.0f} degrees along {:.0f} degrees", roll.turn * 180.0 / pi,
                                 roll.direction * 180.0 / pi),
                     rolled_start(model_, roll)};
        } else {
            const int number = i - static_cast<int>(rolls_.size()) + 1;
            start = {fmt::format("hills and valleys {}", number), wavy_start(model_, seed_ + number)};
        }
        // A start as symmetric as the sheet would stay so, on a saddle if need be.
        start.x += noisy_start(model_, seed_ + i, noise_) - model_.initial();
        return start;
    }

  private:
    const Model& model_;
    int seed_;
    double noise_;
    int waves_;
    std::vector<Roll> rolls_;
};

bool certain(const Equilibrium& e) { return e.status == SolveStatus::converged && e.stable; }

SolveOptions in_short_steps(const Scene& scene) {
    SolveOptions options = scene.solver;
    options.largest_turn = 0.1;
    return options;
}

void sort_by_energy(std::vector<Alternative>& shapes) {
    std::ranges::stable_sort(shapes, {}, [](const Alternative& a) { return a.equilibrium.energy.total(); });
}

}  // namespace

AlternativeSearch find_alternatives(const Scene& scene, const PrintMesh& layout, const Model& model,
                                    const Equilibrium& ordinary, int wanted, const Control& control) {
    const ReleasePath path(scene, layout, model);
    const SolveOptions search_options = in_short_steps(scene);
    ShapeCatalogue rough(path.first_model(), search_options, control);
    ShapeCatalogue fine(model, to_the_end(scene), control);
    AlternativeSearch search;
    for (const SheetSymmetry& symmetry : fine.symmetries()) search.symmetries.push_back(symmetry.name);
    std::vector<int> fine_number;  // of each rough shape; -1 = it did not survive refinement
    if (certain(ordinary)) {
        fine.add(ordinary);
        search.shapes.push_back({ordinary, {"the flat state"}});
    }

    const auto found = [](const StartTried& start, const ShapeCatalogue::Match& match) {
        return match.symmetry.empty() ? start.name : start.name + " (as its image, " + match.symmetry + ")";
    };
    const Starts starts(path.first_model(), scene, wanted);
    for (int i = 0; i < starts.count() && static_cast<int>(search.shapes.size()) < wanted; ++i) {
        if (control.stopped() || control.timed_out()) break;
        control.say(
            {"search", static_cast<double>(i) / starts.count(),
             fmt::format("start {} of at most {}, {} shapes", i + 1, starts.count(), search.shapes.size())});
        const StartTried start = starts[i];
        ++search.starts;
        Equilibrium end = solve(path.first_model(), search_options,
                                {.stop = control.stop, .deadline = control.deadline}, &start.x);
        if (!certain(end)) {
            ++search.without_result;
            continue;
        }
        const ShapeCatalogue::Match known = rough.find(end);
        if (known.number >= 0) {
            if (fine_number[known.number] >= 0)
                search.shapes[fine_number[known.number]].found_from.push_back(found(start, known));
            continue;
        }
        rough.add(end);
        fine_number.push_back(-1);
        Equilibrium refined = path.from(std::move(end), {.stop = control.stop, .deadline = control.deadline});
        if (!certain(refined)) {
            ++search.without_result;
            continue;
        }
        const ShapeCatalogue::Match same = fine.find(refined);
        if (same.number >= 0) {
            fine_number.back() = same.number;
            search.shapes[same.number].found_from.push_back(found(start, same));
        } else {
            fine_number.back() = fine.add(refined);
            search.shapes.push_back({std::move(refined), {start.name}});
        }
    }
    search.interrupted = control.stopped();
    sort_by_energy(search.shapes);
    return search;
}

}  // namespace ruche
