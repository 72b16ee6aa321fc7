#include "simulator/loads/side_regions.h"

namespace faultsim {

std::vector<SideRegions> side_regions(const FaultGeometry& geometry,
                                      const std::vector<int>& region_of_load) {
  std::vector<SideRegions> sides(geometry.nodes.size());
  for (std::size_t k = 0; k < sides.size(); ++k) {
    double most_minus = 0, most_plus = 0;
    for (const PressurePair& pair : geometry.nodes[k].pressure) {
      const double minus = pair.weight * pair.minus_fraction;
      const double plus = pair.weight * pair.plus_fraction;
      if (pair.minus_region >= 0 && minus > most_minus) {
        most_minus = minus;
        sides[k].minus = region_of_load[static_cast<std::size_t>(pair.minus_region)];
      }
      if (pair.plus_region >= 0 && plus > most_plus) {
        most_plus = plus;
        sides[k].plus = region_of_load[static_cast<std::size_t>(pair.plus_region)];
      }
    }
  }
  return sides;
}

}  // namespace faultsim
