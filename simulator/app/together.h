#pragma once

#include <functional>

#include "simulator/common/exit_code.h"
#include "simulator/coupled/ranks.h"

namespace faultsim {

/// Throws InputError where mpirun started several processes and the command is not one that shares
/// its work between them; only the first of them says so.
void require_started_alone(const char* command);

/// Work that the processes of one job do together: of one process alone the two functions one after
/// the other. Otherwise the first process speaks for all. What is wrong before the work begins is
/// told once, by the first that
/// met it, and ends all of them with the same code; what goes wrong later, in whichever of them,
/// ends the job with a word, for the others would wait for it. Throws InputError where the
/// processes were started together and do not find each other.
/// @param prepare  not collective. @param work  collective.
ExitCode together(const std::function<void(const Ranks&)>& prepare,
                  const std::function<ExitCode()>& work);

}  // namespace faultsim
