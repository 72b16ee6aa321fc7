#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

/// Inside of the room: places.csv, which says where the pillars of a campaign are.
namespace faultsweep {

/// A line of it: a pillar, in the order of its table.
struct PlaceLine {
  std::string id, fault, section_fault;
  std::optional<double> x, y;                   ///< m, at the top of the panel.
  std::optional<double> azimuth, dip;           ///< deg.
  std::optional<double> top_depth, base_depth;  ///< m, of the panel.
  std::string start_date;                       ///< of its time 0, where the scene says it; or "".
  std::string refused;                          ///< why it is no case; "" = it is one.

  static std::string header();
  std::string text() const;
};

/// Throws InputError with the first line that is none. Files of before there were dates and refused
/// pillars in them are read too.
std::vector<PlaceLine> read_places(const std::filesystem::path& file);

}  // namespace faultsweep
