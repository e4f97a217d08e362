#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "ruche/core/parallel.hpp"
#include "ruche/energy/sparsity.hpp"
#include "ruche/energy/term.hpp"

namespace ruche {

/// What an evaluation fills; sized once, then reused.
struct AssembledSums {
    Eigen::VectorXd gradient;
    std::vector<double> hessian;  ///< values of a NodePattern
};

/// Sums a term over its elements, in parallel and with the same bits at any thread count: elements are
/// grouped in blocks that do not depend on the threads, blocks that share a node have different colours, and
/// colours follow one another.
template <Term T>
class TermAssembly {
  public:
    explicit TermAssembly(T term) : term_(std::move(term)) {}

    const T& term() const { return term_; }

    NodePattern::Cliques cliques() const {
        NodePattern::Cliques result{.nodes = {}, .width = slots};
        result.nodes.reserve(static_cast<std::size_t>(term_.element_count()) * slots);
        for (int e = 0; e < term_.element_count(); ++e) {
            const auto nodes = term_.nodes(e);
            result.nodes.insert(result.nodes.end(), nodes.begin(), nodes.end());
        }
        return result;
    }

    void prepare(const NodePattern& pattern) {
        pattern_ = &pattern;
        colour_blocks();
        const int count = term_.element_count();
        offsets_.resize(static_cast<std::size_t>(count) * pairs);
        parallel_for((count + block_size - 1) / block_size, [&](std::size_t block) {
            for (int e = static_cast<int>(block) * block_size;
                 e < std::min(count, int(block + 1) * block_size); ++e) {
                const auto nodes = term_.nodes(e);
                int* offset = offsets_.data() + static_cast<std::size_t>(e) * pairs;
                for (int i = 0; i < slots; ++i) {
                    for (int j = 0; j <= i; ++j, ++offset) {
                        *offset = nodes[i] < 0 || nodes[j] < 0
                                      ? -1
                                      : pattern.block_offset(std::max(nodes[i], nodes[j]),
                                                             std::min(nodes[i], nodes[j]));
                    }
                }
            }
        });
    }

    /// Adds gradient and Hessian to `sums` as far as `order` asks; returns the energy.
    double add(const Unknowns& x, Order order, AssembledSums& sums) const {
        std::vector<double> energies(block_count());
        for (const std::vector<int>& colour : colours_) {
            parallel_for(colour.size(),
                         [&](std::size_t i) { energies[colour[i]] = add_block(colour[i], x, order, sums); });
        }
        double energy = 0.0;
        for (const double e : energies) energy += e;
        return energy;
    }

  private:
    static constexpr int slots = T::vertex_slots + T::edge_slots;
    static constexpr int pairs = slots * (slots + 1) / 2;
    static constexpr int block_size = 128;

    int block_count() const { return (term_.element_count() + block_size - 1) / block_size; }

    void colour_blocks() {
        colours_.clear();
        // Bit c of a node's mask: a block of colour c touches it. Blocks beyond 63 colours run one after the
        // other.
        std::vector<std::uint64_t> used(pattern_->node_count(), 0);
        constexpr int shared_colours = 63;
        std::vector<std::vector<int>> alone;
        for (int block = 0; block < block_count(); ++block) {
            const int end = std::min(term_.element_count(), (block + 1) * block_size);
            std::uint64_t taken = 0;
            const auto for_each_node = [&](auto&& use) {
                for (int e = block * block_size; e < end; ++e) {
                    for (const int node : term_.nodes(e)) {
                        if (node >= 0) use(used[node]);
                    }
                }
            };
            for_each_node([&](std::uint64_t mask) { taken |= mask; });
            const int colour = std::countr_one(taken);
            if (colour >= shared_colours) {
                alone.push_back({block});
                continue;
            }
            for_each_node([&](std::uint64_t& mask) { mask |= std::uint64_t{1} << colour; });
            if (colour >= static_cast<int>(colours_.size())) colours_.resize(colour + 1);
            colours_[colour].push_back(block);
        }
        colours_.insert(colours_.end(), alone.begin(), alone.end());
    }

    static constexpr int local_start(int slot) {
        return slot < T::vertex_slots ? 3 * slot : 3 * T::vertex_slots + (slot - T::vertex_slots);
    }
    static constexpr int local_size(int slot) { return slot < T::vertex_slots ? 3 : 1; }

    double add_block(int block, const Unknowns& x, Order order, AssembledSums& sums) const {
        const int end = std::min(term_.element_count(), (block + 1) * block_size);
        double energy = 0.0;
        for (int e = block * block_size; e < end; ++e) {
            const auto local = term_.evaluate(e, x, order);
            energy += local.value;
            if (order == Order::value) continue;
            const auto nodes = term_.nodes(e);
            for (int i = 0; i < slots; ++i) {
                if (nodes[i] < 0) continue;
                const int at = pattern_->first_unknown(nodes[i]);
                for (int c = 0; c < local_size(i); ++c)
                    sums.gradient[at + c] += local.gradient[local_start(i) + c];
            }
            if (wants_hessian(order)) scatter(e, nodes, local.hessian, sums.hessian.data());
        }
        return energy;
    }

    template <class Nodes, class Matrix>
    void scatter(int element, const Nodes& nodes, const Matrix& h, double* values) const {
        const int* offset = offsets_.data() + static_cast<std::size_t>(element) * pairs;
        for (int i = 0; i < slots; ++i) {
            for (int j = 0; j <= i; ++j, ++offset) {
                if (*offset < 0) continue;
                // Rows belong to the node with the larger number. A node that fills two slots of an element
                // gets both off-diagonal blocks in its diagonal block.
                const bool swap = nodes[i] < nodes[j];
                const int row = swap ? j : i;
                const int column = swap ? i : j;
                double* out = values + *offset;
                const int length = pattern_->column_length(nodes[column]);
                const int r0 = local_start(row);
                const int c0 = local_start(column);
                const bool both = i != j && nodes[i] == nodes[j];
                for (int c = 0; c < local_size(column); ++c, out += length) {
                    for (int r = 0; r < local_size(row); ++r) {
                        out[r] += h(r0 + r, c0 + c);
                        if (both) out[r] += h(c0 + r, r0 + c);
                    }
                }
            }
        }
    }

    T term_;
    const NodePattern* pattern_ = nullptr;
    std::vector<std::vector<int>> colours_;
    std::vector<int> offsets_;
};

}  // namespace ruche
