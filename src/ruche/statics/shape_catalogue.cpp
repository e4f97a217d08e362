#include "ruche/statics/shape_catalogue.hpp"

#include <algorithm>
#include <cmath>

#include "ruche/statics/retraction.hpp"
#include "ruche/statics/transfer.hpp"

namespace ruche {
namespace {

constexpr double same_shape = 1e-3;      // mm
constexpr double close_energies = 0.01;  // relative; an image on the same mesh differs by discretisation only
constexpr double still_the_image = 0.1;  // of the shape's radius of gyration: how far it may move

std::vector<Vec3> shape_of(const Model& model, const Eigen::VectorXd& x) {
    std::vector<Vec3> shape;
    shape.reserve(model.vertex_count());
    for (int v = 0; v < model.vertex_count(); ++v)
        shape.emplace_back(x.segment<3>(3 * static_cast<Eigen::Index>(v)));
    return shape;
}

double radius_of_gyration(const std::vector<Vec3>& shape) {
    Vec3 sum = Vec3::Zero();
    double squares = 0.0;
    for (const Vec3& p : shape) {
        sum += p;
        squares += p.squaredNorm();
    }
    const auto count = static_cast<double>(shape.size());
    return std::sqrt(std::max(0.0, squares / count - (sum / count).squaredNorm()));
}

bool certain(const Equilibrium& state) { return state.status == SolveStatus::converged && state.stable; }

bool energies_are_close(const Equilibrium& a, const Equilibrium& b) {
    const double size = std::max(std::abs(a.energy.total()), std::abs(b.energy.total()));
    return std::abs(a.energy.total() - b.energy.total()) <= close_energies * size;
}

}  // namespace

ShapeCatalogue::ShapeCatalogue(const Model& model, const SolveOptions& options, const Control& control)
    : model_(model), options_(options), control_(control), symmetries_(find_symmetries(model.input())) {}

const std::vector<ShapeCatalogue::Image>& ShapeCatalogue::images_of(int number) {
    std::optional<std::vector<Image>>& known = images_[number];
    if (known) return *known;
    known.emplace();
    const Equilibrium& state = states_[number];
    const double far = still_the_image * radius_of_gyration(shape_of(model_, state.x));
    Retraction retraction(model_);
    for (const SheetSymmetry& symmetry : symmetries_) {
        const ShapeImage mapped = image(symmetry, model_.input(), state.x);
        const Eigen::VectorXd start = transfer({mapped.layout, mapped.print, mapped.x}, model_, retraction);
        const Equilibrium end = solve(model_, options_, control_, &start);
        std::vector<Vec3> shape = shape_of(model_, end.x);
        if (certain(end) && energies_are_close(end, state) && align(shape_of(model_, start), shape).rms < far)
            known->push_back({.symmetry = &symmetry, .shape = std::move(shape)});
    }
    return *known;
}

ShapeCatalogue::Match ShapeCatalogue::find(const Equilibrium& state) {
    const std::vector<Vec3> shape = shape_of(model_, state.x);
    for (int i = 0; i < static_cast<int>(states_.size()); ++i) {
        if (align(shape_of(model_, states_[i].x), shape).rms < same_shape)
            return {.number = i, .symmetry = {}};
    }
    for (int i = 0; i < static_cast<int>(states_.size()); ++i) {
        if (!energies_are_close(states_[i], state)) continue;
        for (const Image& image : images_of(i)) {
            if (align(image.shape, shape).rms < same_shape)
                return {.number = i, .symmetry = image.symmetry->name};
        }
    }
    return {};
}

int ShapeCatalogue::add(Equilibrium state) {
    states_.push_back(std::move(state));
    images_.emplace_back();
    return static_cast<int>(states_.size()) - 1;
}

}  // namespace ruche
