#pragma once

#include <chrono>

namespace ruche {

/// Guesses how long a release still takes. A release climbs meshes, each with about seven times the triangles
/// of the one before; a step costs about the 1.2th power of their number, and a mesh takes about five steps.
/// The pace is measured as it goes. Good to a factor of two.
class TimeLeft {
  public:
    using Clock = std::chrono::steady_clock;

    /// To be told each shape; the first is the flat sheet on the finest mesh.
    void step(int triangles, int iteration, Clock::time_point now);

    /// Seconds; negative while nothing is known.
    double seconds() const { return left_; }
    /// Of the steps' work, 0 to 1.
    double share() const { return share_; }

  private:
    int finest_ = 0;
    int triangles_ = 0;
    Clock::time_point last_;
    double pace_ = 0.0;  // seconds per unit of work
    double spent_ = 0.0;
    double left_ = -1.0;
    double share_ = 0.0;
};

}  // namespace ruche
