#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "ruche/study/calibration/law_fit.hpp"

/// Tension tests of the homogeneous law, without a machine.
namespace ruche::test {

inline constexpr double seven_angles[] = {0, 15, 30, 45, 60, 75, 90};

/// Unloading from a stretch down to nearly one, with widths.
LawCurve exact_curve(const Material& material, double angle_deg, double largest_stretch = 1.7, int rows = 60);

/// Normally distributed noise of a fraction of the curve's largest stress, and of its largest transverse
/// strain.
void add_noise(LawCurve& curve, double fraction, std::uint64_t seed);

/// A machine's CSV of one cycle of such a test on a sample of 110 x 20 mm: loading is a tenth stiffer.
std::string machine_csv(const LawCurve& unloading, const Material& material);

/// A folder in the tests' working folder, removed at the end.
class TestFolder {
  public:
    explicit TestFolder(const std::string& name);
    ~TestFolder();
    TestFolder(const TestFolder&) = delete;
    TestFolder& operator=(const TestFolder&) = delete;
    /// Writes a file; returns its path.
    std::string write(const std::string& name, const std::string& contents) const;
    const std::string& path() const { return path_; }

  private:
    std::string path_;
};

}  // namespace ruche::test
