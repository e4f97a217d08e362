#pragma once

#include "ruche/study/calibration/calibration.hpp"

namespace ruche {

/// Values that hold at every pre-stretch and do not come from a fit: thickness, density, plastic. What nobody
/// measured is taken from the paper's fabric and plastic and called assumed.
CardSet measured_values(const Calibration& calibration);

/// The fabric's law of one set, with intervals, files and what could not be determined.
void add_law_values(CardSet& set, const Calibration& calibration, const CalibratedSet& fitted);

/// Mean of repeated readings with the 95 % interval of the mean.
CardValue mean_of(const std::vector<double>& readings, const std::string& source);

/// "tension-00.csv sha256:..." of a file. Throws InputError when it cannot be read.
std::string file_with_hash(const std::string& path);

/// The card as a TOML file that `load_card` reads.
std::string card_text(const MaterialCard& card);

}  // namespace ruche
