#include <algorithm>
#include <array>
#include <type_traits>

#include "ruche/energy/model_parts.hpp"

namespace ruche {

Model::Patch Model::patch(std::span<const int> nodes, std::span<const char> held) const {
    Patch patch;
    for (const int node : nodes) {
        const int first = parts_->pattern->first_unknown(node);
        for (int u = first; u < first + parts_->pattern->node_size(node); ++u) {
            if (held.empty() || !held[u]) patch.unknowns_.push_back(u);
        }
    }
    std::sort(patch.unknowns_.begin(), patch.unknowns_.end());
    thread_local std::vector<int> place;  // of an unknown in the patch; all -1 between calls
    place.resize(std::max(place.size(), static_cast<std::size_t>(size())), -1);
    for (int i = 0; i < patch.size(); ++i) place[patch.unknowns_[i]] = i;
    std::size_t term = 0;
    parts_->for_each_term([&](const auto& assembly) {
        constexpr int width = std::remove_cvref_t<decltype(assembly)>::unknowns_per_element;
        Patch::Elements& elements = patch.terms_[term++];
        elements.numbers = assembly.elements_at(nodes);
        elements.local.resize(elements.numbers.size() * width);
        int* local = elements.local.data();
        for (const int element : elements.numbers) {
            assembly.unknowns_of(element, local);
            for (int i = 0; i < width; ++i, ++local) *local = *local >= 0 ? place[*local] : -1;
        }
    });
    for (const int unknown : patch.unknowns_) place[unknown] = -1;
    return patch;
}

void Model::add_gradient(const Patch& patch, const Eigen::VectorXd& x, double factor,
                         Eigen::VectorXd& gradient) const {
    const Unknowns unknowns = parts_->unknowns(x);
    std::size_t term = 0;
    parts_->for_each_term([&](const auto& assembly) {
        constexpr int width = std::remove_cvref_t<decltype(assembly)>::unknowns_per_element;
        std::array<int, width> global;
        for (const int element : patch.terms_[term++].numbers) {
            const auto local = assembly.term().evaluate(element, unknowns, Order::gradient);
            assembly.unknowns_of(element, global.data());
            for (int i = 0; i < width; ++i) {
                if (global[i] >= 0) gradient[global[i]] += factor * local.gradient[i];
            }
        }
    });
}

double Model::evaluate(const Patch& patch, const Eigen::VectorXd& x, Order order, DenseSums& sums) const {
    const Unknowns unknowns = parts_->unknowns(x);
    if (order != Order::value) sums.gradient.setZero(patch.size());
    if (order.wants_hessian()) sums.hessian.setZero(patch.size(), patch.size());
    double energy = 0.0;
    std::size_t term = 0;
    parts_->for_each_term([&](const auto& assembly) {
        constexpr int width = std::remove_cvref_t<decltype(assembly)>::unknowns_per_element;
        const Patch::Elements& elements = patch.terms_[term++];
        const int* local = elements.local.data();
        for (const int element : elements.numbers) {
            energy += assembly.add_dense(element, unknowns, order, local, sums);
            local += width;
        }
    });
    for (int i = 0; i < patch.size(); ++i) {
        const int u = patch.unknowns_[i];
        if (u >= parts_->dead_load.size()) break;  // ascending: edge unknowns come last
        energy -= parts_->dead_load[u] * x[u];
        if (order != Order::value) sums.gradient[i] -= parts_->dead_load[u];
    }
    return energy;
}

}  // namespace ruche
