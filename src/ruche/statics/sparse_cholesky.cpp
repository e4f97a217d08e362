#include "ruche/statics/sparse_cholesky.hpp"

#include <metis.h>

#include <algorithm>
#include <mutex>
#include <new>
#include <numeric>
#include <stdexcept>

#include "ruche/core/memory.hpp"
#include "ruche/core/parallel.hpp"

extern "C" void openblas_set_num_threads(int threads);
extern "C" char* openblas_get_corename();
extern "C" void* blas_memory_alloc(int);
extern "C" void blas_memory_free(void*);

namespace ruche {
namespace {

/// Sets BLAS up: one thread, because parallelism is ours and threads of BLAS spin while they wait for each
/// other, which is ruinous on a busy machine; and a buffer for each thread of ours at once, because BLAS
/// tries for ever where it cannot have one later. Throws std::bad_alloc.
void prepare_blas() {
    constexpr std::size_t buffer_bytes = 135'000'000;  // of address space
    static std::mutex one_at_a_time;
    static int buffers = 0;
    const std::scoped_lock lock(one_at_a_time);
    openblas_set_num_threads(1);
    if (buffers >= thread_count()) return;
    std::vector<void*> taken(thread_count());
    if (memory_available() < taken.size() * buffer_bytes) throw std::bad_alloc();
    for (void*& buffer : taken) buffer = blas_memory_alloc(0);
    for (void* buffer : taken) blas_memory_free(buffer);
    buffers = thread_count();
}

/// Elimination order of a model's nodes.
std::vector<int> node_order(const Model& model, std::span<const int> vertex_order) {
    const int vertices = model.vertex_count();
    std::vector<int> rank(vertices);
    for (int k = 0; k < vertices; ++k) rank[vertex_order[k]] = k;
    std::vector<std::vector<int>> before(vertices);  // edge unknowns
    for (int node = vertices; node < model.pattern().node_count(); ++node) {
        const std::array<int, 4> around = model.vertices_of_edge_unknown(node - vertices);
        const int first =
            *std::min_element(around.begin(), around.end(), [&](int a, int b) { return rank[a] < rank[b]; });
        before[first].push_back(node);
    }
    std::vector<int> order;
    order.reserve(model.pattern().node_count());
    for (const int v : vertex_order) {
        order.insert(order.end(), before[v].begin(), before[v].end());
        order.push_back(v);
    }
    return order;
}

std::vector<int> node_sizes(const NodePattern& pattern) {
    std::vector<int> sizes(pattern.node_count());
    for (int node = 0; node < pattern.node_count(); ++node) sizes[node] = pattern.node_size(node);
    return sizes;
}

}  // namespace

SparseCholesky::SparseCholesky(const SymmetricPattern& pattern, std::vector<int> elimination_order)
    : SparseCholesky({pattern, std::vector<int>(pattern.size, 1)}, pattern, std::move(elimination_order)) {}

SparseCholesky::SparseCholesky(const Model& model, std::span<const int> vertex_order)
    : SparseCholesky(
          {{model.pattern().node_count(), model.pattern().row_start(), model.pattern().row_nodes()},
           node_sizes(model.pattern())},
          {model.size(), model.pattern().column_start(), model.pattern().row_index()},
          node_order(model, vertex_order)) {}

SparseCholesky::SparseCholesky(const NodeGraph& graph, const SymmetricPattern& pattern,
                               std::vector<int> node_order)
    : factor_(analyse(graph, std::move(node_order)), pattern, graph.sizes) {
    prepare_blas();
}

std::string blas_kernels() { return openblas_get_corename(); }

std::vector<int> nested_dissection(std::span<const int> start, std::span<const int> neighbours) {
    static_assert(sizeof(idx_t) == sizeof(int), "METIS with 32-bit indices");
    idx_t count = static_cast<idx_t>(start.size()) - 1;
    std::vector<int> order(count);
    std::iota(order.begin(), order.end(), 0);
    if (neighbours.empty()) return order;
    std::vector<idx_t> xadj(start.begin(), start.end());
    std::vector<idx_t> adjncy(neighbours.begin(), neighbours.end());
    std::vector<idx_t> position(count);
    idx_t options[METIS_NOPTIONS];
    METIS_SetDefaultOptions(options);
    options[METIS_OPTION_SEED] = 1;
    options[METIS_OPTION_NUMBERING] = 0;
    // METIS draws from one sequence of random numbers per process: two at a time would change each other's.
    static std::mutex one_at_a_time;
    const std::scoped_lock lock(one_at_a_time);
    const int outcome =
        METIS_NodeND(&count, xadj.data(), adjncy.data(), nullptr, options, order.data(), position.data());
    if (outcome == METIS_ERROR_MEMORY) throw std::bad_alloc();
    if (outcome != METIS_OK) throw std::runtime_error("METIS found no elimination order");
    return order;
}

std::vector<int> vertex_elimination_order(const NodePattern& pattern) {
    const int vertices = pattern.vertex_count();
    std::vector<int> start(vertices + 1, 0);
    const auto for_each_pair = [&](auto&& use) {
        for (int column = 0; column < vertices; ++column) {
            for (const int row : pattern.rows_of(column)) {
                if (row > column && row < vertices) use(row, column);
            }
        }
    };
    for_each_pair([&](int row, int column) { ++start[row + 1], ++start[column + 1]; });
    std::partial_sum(start.begin(), start.end(), start.begin());
    std::vector<int> neighbours(start.back());
    std::vector<int> next(start.begin(), start.end() - 1);
    for_each_pair(
        [&](int row, int column) { neighbours[next[row]++] = column, neighbours[next[column]++] = row; });
    return nested_dissection(start, neighbours);
}

}  // namespace ruche
