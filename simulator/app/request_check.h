#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

namespace faultsim {

/// The request of a line of the worker protocol (schemas/worker_protocol.md), with its number under
/// "line". @throws InputError that names the line and what is expected, where it is neither a base
/// scene nor a run nor a cancellation: what it asks for cannot even be answered.
nlohmann::json request_of_line(const std::string& text, int number);

/// @throws InputError that lists all that is wrong with a run, by which only that run fails.
/// @param run  from request_of_line, with a number under "run".
/// @param bases  the base scenes that were sent before.
void require_run(const nlohmann::json& run, const std::map<std::int64_t, nlohmann::json>& bases);

}  // namespace faultsim
