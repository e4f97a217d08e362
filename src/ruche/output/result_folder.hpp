#pragma once

#include <string>
#include <vector>

#include "ruche/core/control.hpp"
#include "ruche/scene/result.hpp"
#include "ruche/scene/simulate.hpp"

namespace ruche {

/// Throws std::runtime_error when results could not be written there: a file stands in the way, or there is
/// no permission. To be asked before a long computation.
void check_result_folder(const std::string& folder);

/// Whether the folder holds the result of a run that came to its end.
bool holds_finished_result(const std::string& folder);

/// Makes the film for the page's slider, where the scene asks for one and the program can write the page;
/// says in the result how long that took.
void add_film(Result& result, const Control& control = {});

/// `write_outputs`, but an interrupted result does not replace a finished one: then only state.ruche is
/// written. Returns the paths written. Throws std::runtime_error when the disk does not take it; the earlier
/// result is then still there. Alternatives of an earlier result that are not in this one's list are removed.
std::vector<std::string> write_result(const Result& result, const std::string& folder,
                                      const Control& control = {});

/// The ordinary result in `folder`, each shape in a folder of its own below (see alternative_folder). Returns
/// the paths written, the ordinary result's last.
std::vector<std::string> write_result(const ResultWithAlternatives& found, const std::string& folder,
                                      const Control& control = {});

}  // namespace ruche
