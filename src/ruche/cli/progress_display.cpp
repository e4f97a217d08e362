#include "ruche/cli/progress_display.hpp"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace ruche {

using namespace std::chrono_literals;

ProgressDisplay::ProgressDisplay() : terminal_(isatty(STDERR_FILENO) == 1) {}

ProgressDisplay::~ProgressDisplay() { clear(); }

void ProgressDisplay::clear() {
    if (bar_shown_) std::fputs("\r\x1b[K", stderr);
    bar_shown_ = false;
}

void ProgressDisplay::show(const Progress& progress) {
    const auto now = std::chrono::steady_clock::now();
    const bool new_phase = phase_ != progress.phase;
    const auto pause = terminal_ ? 50ms : 2000ms;
    if (!new_phase && progress.fraction < 1.0 && now - last_ < pause) return;
    if (!terminal_ && progress.fraction == 0.0) return;  // only announces: nothing is known yet
    phase_ = progress.phase;
    last_ = now;
    if (terminal_)
        show_bar(progress);
    else
        fmt::print(stderr, "{}: {}\n", progress.phase, progress.text);
}

void ProgressDisplay::show_bar(const Progress& progress) {
    constexpr int cells = 24;
    winsize window = {};
    const bool known = ioctl(STDERR_FILENO, TIOCGWINSZ, &window) == 0 && window.ws_col > 0;
    const int full = static_cast<int>(cells * std::clamp(progress.fraction, 0.0, 1.0));
    std::string line = fmt::format("{:8} [{:24}] {}", progress.phase,
                                   std::string(static_cast<std::size_t>(full), '#'), progress.text);
    line.resize(std::min<std::size_t>(line.size(), known ? window.ws_col - 1U : 79U));
    std::fputs(("\r" + line + "\x1b[K").c_str(), stderr);
    std::fflush(stderr);
    bar_shown_ = true;
}

}  // namespace ruche
