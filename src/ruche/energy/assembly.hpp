#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <memory>
#include <numeric>
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

/// The same for a few unknowns.
struct DenseSums {
    Eigen::VectorXd gradient;
    Eigen::MatrixXd hessian;
};

/// Sums a term over its elements, in parallel and with the same bits at any thread count: elements are
/// grouped in blocks that do not depend on the threads, blocks that share a node have different colours, and
/// colours follow one another.
template <Term T>
class TermAssembly {
  public:
    explicit TermAssembly(T term) : term_(std::move(term)) {}

    const T& term() const { return term_; }

    /// A term with the same nodes takes the place of this one.
    void exchange(T term) { term_ = std::move(term); }

    NodePattern::Cliques cliques() const {
        NodePattern::Cliques result{.nodes = {}, .width = slots};
        result.nodes.reserve(static_cast<std::size_t>(term_.element_count()) * slots);
        for (int e = 0; e < term_.element_count(); ++e) {
            const auto nodes = term_.nodes(e);
            result.nodes.insert(result.nodes.end(), nodes.begin(), nodes.end());
        }
        return result;
    }

    void prepare(std::shared_ptr<const NodePattern> shared_pattern) {
        pattern_ = std::move(shared_pattern);
        const NodePattern& pattern = *pattern_;
        colour_blocks();
        list_elements_of_nodes();
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

    /// Elements that touch any of `nodes`, ascending.
    std::vector<int> elements_at(std::span<const int> nodes) const {
        std::vector<int> found;
        for (const int node : nodes) {
            found.insert(found.end(), elements_of_node_.begin() + first_element_[node],
                         elements_of_node_.begin() + first_element_[node + 1]);
        }
        std::sort(found.begin(), found.end());
        found.erase(std::unique(found.begin(), found.end()), found.end());
        return found;
    }

    /// Adds the gradient and Hessian of one element to dense ones; `local[i]` says where the element's i-th
    /// unknown stands in them, -1 = nowhere. Returns its energy.
    double add_dense(int element, const Unknowns& x, Order order, const int* local, DenseSums& sums) const {
        const auto own = term_.evaluate(element, x, order);
        if (order == Order::value) return own.value;
        for (int i = 0; i < unknowns_per_element; ++i) {
            if (local[i] < 0) continue;
            sums.gradient[local[i]] += own.gradient[i];
            if (!order.wants_hessian()) continue;
            for (int j = 0; j < unknowns_per_element; ++j) {
                if (local[j] >= 0)
                    sums.hessian(local[i], local[j]) += own.hessian(std::max(i, j), std::min(i, j));
            }
        }
        return own.value;
    }

    /// The global number of each of the element's unknowns, -1 where it has fewer.
    void unknowns_of(int element, int* unknowns) const {
        const auto nodes = term_.nodes(element);
        for (int i = 0; i < slots; ++i) {
            for (int c = 0; c < local_size(i); ++c)
                unknowns[local_start(i) + c] = nodes[i] < 0 ? -1 : pattern_->first_unknown(nodes[i]) + c;
        }
    }
    static constexpr int unknowns_per_element = 3 * T::vertex_slots + T::edge_slots;

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

    void list_elements_of_nodes() {
        first_element_.assign(pattern_->node_count() + 1, 0);
        const auto for_each_node = [&](auto&& use) {
            for (int e = 0; e < term_.element_count(); ++e) {
                for (const int node : term_.nodes(e)) {
                    if (node >= 0) use(e, node);
                }
            }
        };
        for_each_node([&](int, int node) { ++first_element_[node + 1]; });
        std::partial_sum(first_element_.begin(), first_element_.end(), first_element_.begin());
        elements_of_node_.resize(first_element_.back());
        std::vector<int> next(first_element_.begin(), first_element_.end() - 1);
        for_each_node([&](int e, int node) { elements_of_node_[next[node]++] = e; });
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
            if (order.wants_hessian()) scatter(e, nodes, local.hessian, sums.hessian.data());
        }
        return energy;
    }

    /// `h`: its lower triangle. Vertices come first, so the loops know the sizes of their blocks.
    template <class Nodes, class Matrix>
    void scatter(int element, const Nodes& nodes, const Matrix& h, double* values) const {
        const int* offset = offsets_.data() + static_cast<std::size_t>(element) * pairs;
        for (int i = 0; i < T::vertex_slots; ++i) {
            for (int j = 0; j <= i; ++j, ++offset) scatter_block<3, 3>(i, j, nodes, h, values, *offset);
        }
        for (int i = T::vertex_slots; i < slots; ++i) {
            for (int j = 0; j < T::vertex_slots; ++j, ++offset)
                scatter_block<1, 3>(i, j, nodes, h, values, *offset);
            for (int j = T::vertex_slots; j <= i; ++j, ++offset)
                scatter_block<1, 1>(i, j, nodes, h, values, *offset);
        }
    }

    /// The block of slots i >= j. In the pattern its rows belong to the node with the larger number.
    template <int Rows, int Columns, class Nodes, class Matrix>
    void scatter_block(int i, int j, const Nodes& nodes, const Matrix& h, double* values, int offset) const {
        if (offset < 0) return;
        double* out = values + offset;
        const int length = pattern_->column_length(std::min(nodes[i], nodes[j]));
        const int r0 = local_start(i);
        const int c0 = local_start(j);
        if (i == j) {
            for (int c = 0; c < Columns; ++c, out += length) {
                for (int r = 0; r < Rows; ++r) out[r] += h(r0 + std::max(r, c), r0 + std::min(r, c));
            }
        } else if (nodes[i] > nodes[j]) {
            for (int c = 0; c < Columns; ++c, out += length)
                Eigen::Map<Eigen::Matrix<double, Rows, 1>>(out) += h.template block<Rows, 1>(r0, c0 + c);
        } else if (nodes[i] < nodes[j]) {
            for (int c = 0; c < Rows; ++c, out += length) {
                Eigen::Map<Eigen::Matrix<double, Columns, 1>>(out) +=
                    h.template block<1, Columns>(r0 + c, c0).transpose();
            }
        } else if constexpr (Rows == Columns) {
            // A node that fills two slots gets both blocks in its diagonal block.
            for (int c = 0; c < Columns; ++c, out += length) {
                for (int r = 0; r < Rows; ++r) out[r] += h(r0 + r, c0 + c) + h(r0 + c, c0 + r);
            }
        }
    }

    T term_;
    std::shared_ptr<const NodePattern> pattern_;
    std::vector<std::vector<int>> colours_;
    std::vector<int> offsets_;
    std::vector<int> first_element_, elements_of_node_;  // by node, compressed
};

}  // namespace ruche
