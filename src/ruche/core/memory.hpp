#pragma once

#include <cstddef>
#include <span>

namespace ruche {

/// Bytes that the process may still take before an allocation fails or the machine begins to swap: the least
/// of what its limit on address space (ulimit -v), its control group and the machine's free memory leave.
std::size_t memory_available();

/// Bytes that the process holds in memory now.
std::size_t memory_in_use();

/// Asks the system to hand out the memory of a large array now, in few calls: to hand it out page by page as
/// it is first written to takes about twice as long. Where that is not possible nothing happens.
void hand_out(std::span<double> array);

}  // namespace ruche
