#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "simulator/common/errors.h"

/// Fault pillars: places along faults, each with the section across the fault there.
namespace faultsweep {

/// What a column is.
enum class PillarRole {
  id,                   ///< name of the pillar; default: its line.
  fault,                ///< name of its fault: pillars of one are joined in maps, in their order.
  x,                    ///< m, east.
  y,                    ///< m, north.
  azimuth,              ///< deg, strike: from north clockwise; the fault dips to the right of it.
  depth,                ///< m, of the reservoir's top in the footwall.
  offset,               ///< m, how much lower it lies in the hanging wall.
  thickness,            ///< m, of the reservoir on both sides.
  thickness_foot,       ///< m, in the footwall.
  thickness_hanging,    ///< m, in the hanging wall.
  dip,                  ///< deg from the vertical, towards the hanging wall.
  dip_from_horizontal,  ///< deg; 90 deg less dip.
  until,                ///< the date, 2005-07-31, at which the pillar's history ends.
};

/// Pillars, line by line.
struct PillarTable {
  /// Another parameter of the scene, by alias or pointer.
  struct Parameter {
    std::string name, unit;      ///< unit as given; "" = a plain number.
    std::vector<double> values;  ///< in that unit.
    std::string heading;         ///< as the file calls it.
  };
  /// A line that is not all there, with what is.
  struct Refused {
    std::string id, fault;
    long line = 0;
    std::map<PillarRole, double> numbers;
    std::vector<faultsim::Problem> problems;  ///< pointer: the column, as the file calls it.
  };
  std::string source;
  std::vector<long> lines;                            ///< of each pillar, from 1.
  std::vector<std::string> ids, faults;               ///< ids are distinct; a fault may be "".
  std::map<PillarRole, std::vector<double>> numbers;  ///< of the columns there are; m, deg.
  std::vector<std::string> until;                     ///< dates; empty where there is no column.
  std::map<PillarRole, std::string> headings;         ///< what the file calls them.
  std::vector<Parameter> parameters;
  std::vector<std::string> ignored;  ///< columns of the file that nobody asked for.
  std::vector<Refused> refused;      ///< in order of lines.

  std::size_t n_pillars() const { return lines.size(); }
  /// A role's value of a pillar; none where there is no such column.
  std::optional<double> number(PillarRole role, std::size_t pillar) const;
  /// What the file calls a role; "" where there is no such column.
  std::string heading(PillarRole role) const;
  /// A pillar as a line that is refused for a reason to come.
  Refused as_refused(std::size_t pillar) const;
};

/// How a file calls the columns: "depth" -> "TOP_TVD [m]", "friction_angle" -> "PHI [deg]".
using ColumnNames = std::map<std::string, std::string>;

/// Reads a table (common/table_reader.h): a line of columns, each with its unit in brackets, then a
/// line for each pillar. A pillar with a number that is none or out of range, or with the id of
/// another one, is refused alone, as tables mark so what is not known of a place; what damages the
/// table refuses all of it.
/// @param names  empty: the file's columns have the names of roles and of scene parameters; else
///               what is not in it is ignored.
/// Throws InputError with what is wrong, line by line.
PillarTable parse_pillar_table(const std::string& text, const std::string& source,
                               const ColumnNames& names);
/// The same of a file.
PillarTable read_pillar_table(const std::filesystem::path& file, const ColumnNames& names);

/// "depth": the name of a role in tables.
const char* name_of(PillarRole role);

}  // namespace faultsweep
