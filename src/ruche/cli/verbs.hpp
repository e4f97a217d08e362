#pragma once

#include <functional>

#include "ruche/cli/exit_code.hpp"

namespace CLI {
class App;
}

namespace ruche {

/// What the chosen verb does, once the command line is read.
using Action = std::function<ExitCode()>;

/// Each adds one verb with its options to the program; when the user chooses it, `action` is set.
void add_simulate(CLI::App& program, Action& action);
void add_check(CLI::App& program, Action& action);
void add_pattern(CLI::App& program, Action& action);
void add_bench(CLI::App& program, Action& action);
void add_calibrate(CLI::App& program, Action& action);
void add_compare(CLI::App& program, Action& action);
void add_studio(CLI::App& program, Action& action);
void add_cards(CLI::App& program, Action& action);
void add_render(CLI::App& program, Action& action);
void add_virtual_test(CLI::App& program, Action& action);
void add_sensitivity(CLI::App& program, Action& action);
void add_validate(CLI::App& program, Action& action);
void add_template(CLI::App& program, Action& action);

}  // namespace ruche
