#pragma once

#include <vector>

#include "campaign/expression/expression.h"
#include "campaign/store/sqlite.h"

namespace faultsweep {

/// Binds the parameters of an expression's SqlFragment after `position`, which it moves on.
void bind_values(Statement& statement, int& position, const std::vector<Value>& values);

}  // namespace faultsweep
