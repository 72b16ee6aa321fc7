#pragma once

#include <map>
#include <string>
#include <vector>

#include "campaign/store/store.h"

namespace faultsweep {

/// Ids in table `names`. Ids made in a transaction that is rolled back are forgotten again.
struct Store::NameCache {
  std::map<std::string, std::int64_t> ids;
  std::vector<std::string> fresh;  ///< since the transaction began.

  void begin() { fresh.clear(); }
  void roll_back() {
    for (const std::string& name : fresh) ids.erase(name);
    fresh.clear();
  }
};

}  // namespace faultsweep
