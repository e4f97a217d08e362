#pragma once

#include <string>
#include <vector>

#include "ruche/study/virtual_test/virtual_machine.hpp"

namespace ruche {

/// A file of the virtual laboratory, by its name in the folder.
struct LabFile {
    std::string name;
    std::string contents;
};

/// The records of all tests as a machine would have written them, and `campaign.toml`, which `ruche
/// calibrate` reads. `card`: what was tested, for people. Depends on the arguments alone, to the last byte.
std::vector<LabFile> virtual_campaign(const VirtualCurves& curves, const VirtualMachine& machine,
                                      const std::string& card);

}  // namespace ruche
