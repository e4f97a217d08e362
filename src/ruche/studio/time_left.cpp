#include "ruche/studio/time_left.hpp"

#include <algorithm>
#include <cmath>

namespace ruche {

static constexpr double usual_steps = 5.0;
static constexpr double refinement = 7.0;

static double work(double triangles) { return std::pow(triangles, 1.2); }

void TimeLeft::step(int triangles, int iteration, Clock::time_point now) {
    if (finest_ == 0) {
        finest_ = triangles;
        last_ = now;
        return;
    }
    const double seconds = std::chrono::duration<double>(now - last_).count();
    last_ = now;
    if (triangles == triangles_ && iteration > 0) {
        const double measured = seconds / work(triangles);
        pace_ = pace_ == 0.0 ? measured : 0.6 * pace_ + 0.4 * measured;
    }
    triangles_ = triangles;
    double ahead = std::max(1.0, usual_steps - iteration) * work(triangles);
    for (double next = triangles; next < finest_;) {
        next *= refinement;
        if (next > 0.5 * finest_) next = finest_;
        ahead += usual_steps * work(next);
    }
    spent_ += work(triangles);
    share_ = std::max(share_, spent_ / (spent_ + ahead));
    if (pace_ > 0.0) left_ = pace_ * ahead;
}

}  // namespace ruche
