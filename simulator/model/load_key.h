#pragma once

#include <string>

namespace faultsim {

/// Which unit load a column of L stands for.
struct LoadKey {
  enum class Kind { pressure, boundary };
  Kind kind = Kind::pressure;
  int index = 0;      ///< region of the scene, or entry of its list of boundary conditions.
  int material = -1;  ///< pressure: b Δp = 1 Pa in the region's rock of this material, as Biot
                      ///< coefficients belong to materials; boundary: −1.
  friend bool operator==(const LoadKey&, const LoadKey&) = default;
};

/// "pressure:0:2", "boundary:1": for messages.
std::string to_string(const LoadKey& key);

}  // namespace faultsim
