#include "simulator/reading/fault_places.h"

#include "simulator/common/ranges.h"

namespace faultsim {

const std::vector<std::string_view>& place_keys(std::string_view kind) {
  using Keys = std::vector<std::string_view>;
  static const Keys field = {"dip_from_vertical", "length", "y_from", "y_to", "overshoot"};
  static const Keys box = {"center", "strike", "length", "width", "shape", "dip_from_vertical"};
  static const Keys horizons = {"trace",   "first_end",   "last_end",    "listric",
                                "surface", "top",         "bottom",      "dip_from_vertical",
                                "throw",   "throw_share", "throw_reach", "throw_taper"};
  static const Keys none;
  if (kind == "field") return field;
  if (kind == "box") return box;
  return kind == "horizons" ? horizons : none;
}

const std::vector<std::string_view>& all_place_keys() {
  static const std::vector<std::string_view> all = [] {
    std::vector<std::string_view> keys = place_keys("box");
    for (const char* kind : {"field", "horizons"}) {
      for (const std::string_view key : place_keys(kind))
        if (!contains(keys, key)) keys.push_back(key);
    }
    return keys;
  }();
  return all;
}

}  // namespace faultsim
