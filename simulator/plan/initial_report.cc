#include <nlohmann/json.hpp>

#include "simulator/common/text.h"
#include "simulator/plan/plan.h"

namespace faultsim {

nlohmann::json initial_state_to_json(const std::vector<InitialRegion>& regions) {
  nlohmann::json rows = nlohmann::json::array();
  for (const InitialRegion& region : regions) {
    rows.push_back({{"region", region.name},
                    {"depth_m", region.depth},
                    {"sigma_v_pa", region.vertical},
                    {"sigma_across_pa", region.across},
                    {"sigma_along_pa", region.along},
                    {"pressure_pa", region.pressure}});
    if (!region.source.empty()) rows.back()["pressure_from"] = region.source;
  }
  return rows;
}

std::string initial_state_to_text(const std::vector<InitialRegion>& regions) {
  if (regions.empty()) return "";
  constexpr double kBar = 1e5;  // Pa
  std::string text = "initial state at mid-depth, bar (total stress, tension > 0):\n";
  for (const InitialRegion& r : regions) {
    text +=
        formatted("  %-12.60s %6.0f m: vertical %.1f, across %.1f, along %.1f, pressure %.1f%s\n",
                  r.name.c_str(), r.depth, r.vertical / kBar, r.across / kBar, r.along / kBar,
                  r.pressure / kBar, r.source.empty() ? "" : (", mean of the " + r.source).c_str());
  }
  return text;
}

}  // namespace faultsim
