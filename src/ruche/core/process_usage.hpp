#pragma once

namespace ruche {

/// Processor time that all threads of this process have used so far, s.
double processor_seconds();

/// The most memory that this process has held at once so far, MB (1e6 bytes).
double peak_megabytes();

}  // namespace ruche
