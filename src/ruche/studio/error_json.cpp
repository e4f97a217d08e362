#include "ruche/studio/error_json.hpp"

#include <exception>
#include <new>
#include <nlohmann/json.hpp>

#include "ruche/core/error.hpp"
#include "ruche/studio/workspace.hpp"

namespace ruche {

std::string current_error_json() {
    nlohmann::json json;
    try {
        throw;
    } catch (const InputError& error) {
        json = {{"message", error.what()},
                {"key", error.place().key},
                {"problem", error.problem()},
                {"advice", error.advice()}};
    } catch (const std::bad_alloc&) {
        json = {{"message", "out of memory; try larger elements (mesh.size_mm, mesh.fabric_size_mm)"}};
    } catch (const std::exception& error) {
        json = {{"message", error.what()}};
    } catch (...) {
        json = {{"message", "unknown failure"}};
    }
    return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

bool is_input_error() {
    try {
        throw;
    } catch (const InputError&) {
        return true;
    } catch (const OutsideFolder&) {
        return true;
    } catch (const nlohmann::json::exception&) {
        return true;
    } catch (...) {
        return false;
    }
}

}  // namespace ruche
