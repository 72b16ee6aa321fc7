#pragma once

#include <string>
#include <vector>

#include "campaign/pillars/fault_map.h"

/// A map year by year, for ParaView.
namespace faultsweep {

/// What the pillars of a map are like at one time.
struct MapFrame {
  /// Since time 0; where all pillars know its date, of the calendar: 1991.5.
  double year = 0;
  std::vector<FaultMap::Property> properties;  ///< NaN before a history begins and after its end.
};

/// Frames where the first history begins, where each year does from then on, and where the last
/// history ends: of each pillar the last load step by then.
std::vector<MapFrame> make_map_frames(const Store& store, const FaultMap& map);

/// A file of the series: its time and its name.
struct FrameFile {
  double year = 0;
  std::string name;
};
/// ParaView's collection of the files of a series.
std::string frames_to_pvd(const std::vector<FrameFile>& files);

}  // namespace faultsweep
