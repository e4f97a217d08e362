#pragma once

namespace ruche {

/// What the program tells its caller.
enum class ExitCode {
    converged = 0,     ///< and stable; or the verb did what it should
    failed = 1,        ///< something other than the input: disk, memory, a bug
    bad_input = 2,     ///< the message says how to mend it; nothing was written
    unfinished = 3,    ///< not converged or not stable, or a check of `validate` fails; written and marked
    interrupted = 130  ///< by Ctrl-C; the last state is written
};

}  // namespace ruche
