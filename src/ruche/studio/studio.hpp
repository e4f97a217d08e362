#pragma once

#include <atomic>
#include <functional>
#include <string>

namespace ruche {

struct StudioOptions {
    std::string folder = ".";
    int port = 0;  ///< 0: any free one
};

/// Whether the program was built with the studio's page in it.
bool can_open_studio();

/// Serves the studio on this machine's loopback address until `stop` is set: drawings, settings, one queue of
/// releases, results, all in the folder. `ready` is told the address. What still runs at the end is stopped
/// and writes how far it got. Throws InputError for a folder that is none, std::runtime_error for a port in
/// use.
void run_studio(const StudioOptions& options, const std::atomic<bool>& stop,
                const std::function<void(const std::string& address)>& ready);

}  // namespace ruche
