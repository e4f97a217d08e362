#pragma once

#include <string>

#include "ruche/study/validation/validation.hpp"

namespace ruche {

/// What each numerical choice does to each experiment, as HTML: a row for every metric of every experiment of
/// the set `numerics`, a column for every variant that one of them has. The first variant is the default; the
/// others are shares of it, with the range that the uncertainties of both leave. Empty without such
/// experiments.
std::string choice_table(const Validation& validation);

}  // namespace ruche
