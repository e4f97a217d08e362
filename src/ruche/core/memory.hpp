#pragma once

#include <cstddef>

namespace ruche {

/// Bytes that the process may still take before an allocation fails or the machine begins to swap: the least
/// of what its limit on address space (ulimit -v), its control group and the machine's free memory leave.
std::size_t memory_available();

/// Bytes that the process holds in memory now.
std::size_t memory_in_use();

}  // namespace ruche
