#pragma once

#include <functional>
#include <random>
#include <string>
#include <vector>

#include "ruche/core/fields.hpp"
#include "ruche/study/virtual_test/virtual_curves.hpp"

namespace ruche {

enum class MachineFormat { plain, bluehill, zwick, weights };

/// How a testing machine moves, and what it adds to what the sample answers.
struct VirtualMachine {
    MachineFormat format = MachineFormat::plain;
    int cycles = 3;               ///< load and unload
    double speed = 100.0;         ///< of the clamp, mm/min
    double plastic_speed = 10.0;  ///< the same for plastic, which is pulled less far
    double sampling = 5.0;        ///< Hz
    double noise = 0.01;          ///< standard deviation over a channel's largest value
    double hysteresis = 0.1;      ///< widest gap between loading and unloading over the largest force
    int seed = 1;                 ///< of the noise
};

template <>
std::span<const Field<VirtualMachine>> fields<VirtualMachine>();

/// One way of a test: what the sample answers on loading or unloading in a cycle (from 0).
///
/// Fabric unloads along the curve and loads above it, by hysteresis * F_max * 4 u (1 - u) with u the share of
/// the largest displacement, twice as much in the first cycle, and half of that more in each that follows:
/// the simulator's law is that of unloading. Plastic loads along the curve and unloads below it: its modulus
/// is the tangent where loading begins.
class TestBranch {
  public:
    TestBranch(const VirtualCurve& curve, const VirtualMachine& machine, int cycle, bool loading);
    double force(double displacement) const;
    double width(double displacement) const;  ///< 0 where it was not simulated

  private:
    using Function = std::function<double(double)>;
    Function clean_force_, clean_width_;
    double largest_;
    double lift_;  // N, in the middle
};

/// One test as a machine records it.
struct MachineRecord {
    std::vector<double> time;          ///< s
    std::vector<double> displacement;  ///< mm, exact
    std::vector<double> force;         ///< N
    std::vector<double> width;         ///< mm; empty when not measured
};

using NoiseSource = std::mt19937_64;

/// Cycles between rest and the curve's end at constant speed (plastic: one), sampled at regular times. Force
/// and width get normal noise; displacement and time do not.
MachineRecord record(const VirtualCurve& curve, const VirtualMachine& machine, NoiseSource& noise);

/// The record as a file of the machine's kind.
std::string machine_csv(const MachineRecord& record, const std::string& sample, MachineFormat format);

}  // namespace ruche
