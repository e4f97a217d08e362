#pragma once

#include <chrono>
#include <string>

#include "ruche/core/control.hpp"

namespace ruche {

/// Shows on stderr how far a computation is: a bar on a terminal, a line per phase and now and then one in
/// between otherwise.
class ProgressDisplay {
  public:
    ProgressDisplay();
    ~ProgressDisplay();
    ProgressDisplay(const ProgressDisplay&) = delete;
    ProgressDisplay& operator=(const ProgressDisplay&) = delete;

    void show(const Progress& progress);
    void clear();  ///< takes the bar away

  private:
    void show_bar(const Progress& progress);

    bool terminal_;
    bool bar_shown_ = false;
    std::string phase_;
    std::chrono::steady_clock::time_point last_;
};

}  // namespace ruche
