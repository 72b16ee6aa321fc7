#include "simulator/flow/eclipse_grid.h"

#include <opm/io/eclipse/EGrid.hpp>
#include <utility>

#include "simulator/flow/eclipse_files.h"
#include "simulator/flow/eclipse_problems.h"

namespace faultsim {
namespace {

using Opm::EclIO::EclFile;
using Opm::EclIO::EGrid;

/// Places from 0: the unit in INTEHEAD; the number of coordinate systems in GRIDHEAD; in FILEHEAD
/// whether cells have one porosity (0), two (1), or two that both flow (2).
constexpr std::size_t kUnitSystem = 2, kCoordinateSystems = 24, kPorosities = 5;

template <typename T>
std::vector<T> array_of(EclFile& file, const std::string& name) {
  return file.hasKey(name) ? file.get<T>(name) : std::vector<T>{};
}

/// "METRES  " without its blanks.
std::string trimmed(std::string word) {
  word.erase(word.find_last_not_of(' ') + 1);
  return word;
}

class EclipseGridReader : EclipseProblems {
 public:
  explicit EclipseGridReader(const std::filesystem::path& path) : files_(eclipse_files(path)) {}

  EclipseGrid read() {
    std::error_code error;
    if (!std::filesystem::is_regular_file(files_.grid, error)) {
      refuse(files_.grid, "there is no such grid",
             "let the flow simulator write an EGRID (GRIDFILE)");
    } else {
      guarded(files_.grid, [&] { take_grid(); });
      take_neighbours();
    }
    throw_if_any(files_.grid);
    return std::move(grid_);
  }

 private:
  void take_grid() {
    EGrid file(files_.grid.string());
    if (!file.list_of_lgrs().empty()) {
      refuse(files_.grid, "has local grid refinements (" + file.list_of_lgrs().front() + ")",
             "write the grid without them; refined cells are not read");
    }
    if (file.is_radial()) refuse(files_.grid, "is a radial grid", "use a corner-point grid");
    const std::vector<int> head = array_of<int>(file, "GRIDHEAD");
    if (head.size() > kCoordinateSystems && head[kCoordinateSystems] > 1)
      refuse(files_.grid, "has several coordinate systems", "use a grid with one (NUMRES)");
    refuse_two_porosities(array_of<int>(file, "FILEHEAD"));
    if (!problems_.empty()) return;
    grid_.size = file.dimension();
    grid_.coord = array_of<float>(file, "COORD");
    grid_.zcorn = array_of<float>(file, "ZCORN");
    grid_.active = array_of<int>(file, "ACTNUM");
    const std::vector<std::string> unit = array_of<std::string>(file, "GRIDUNIT");
    if (!unit.empty()) grid_.length_unit = trimmed(unit[0]);
    grid_.is_on_map = unit.size() > 1 && unit[1].rfind("MAP", 0) == 0;
    grid_.map_axes = array_of<float>(file, "MAPAXES");
    const std::vector<std::string> map_unit = array_of<std::string>(file, "MAPUNITS");
    if (!map_unit.empty()) grid_.map_unit = trimmed(map_unit[0]);
    take_connections(array_of<int>(file, "NNC1"), array_of<int>(file, "NNC2"));
  }

  /// Their arrays have all values of the matrix, then all of the fractures, and ACTNUM says which
  /// of both a cell has.
  void refuse_two_porosities(const std::vector<int>& head) {
    if (head.size() <= kPorosities || head[kPorosities] == 0) return;
    refuse(files_.grid,
           head[kPorosities] == 1 ? "is a dual porosity grid" : "is a dual permeability grid",
           "write the grid from a model of the same cells without DUALPORO and DUALPERM, and give "
           "the pressures that act on the rock as a table of cells (docs/your-field.md)");
  }

  void take_connections(const std::vector<int>& one, const std::vector<int>& other) {
    if (one.size() != other.size())
      return refuse(files_.grid, "has NNC1 and NNC2 of different lengths", "write it again");
    for (std::size_t c = 0; c < one.size(); ++c)
      grid_.connections.push_back({one[c] - 1, other[c] - 1});
  }

  /// The files beside the grid; none of them is needed.
  void take_neighbours() {
    const std::filesystem::path& init = files_.init;
    std::error_code error;
    if (std::filesystem::is_regular_file(init, error)) {
      guarded(init, [&] {
        EclFile file(init.string());
        take_units(file, init);
        grid_.equilibrium_region = array_of<int>(file, "EQLNUM");
        grid_.fluid_region = array_of<int>(file, "FIPNUM");
        grid_.cell_depth = array_of<float>(file, "DEPTH");
      });
    } else if (!files_.restarts.empty()) {
      guarded(files_.restarts[0], [&] {
        EclFile file(files_.restarts[0].string());
        take_units(file, files_.restarts[0]);
      });
    }
  }

  void take_units(EclFile& file, const std::filesystem::path& path) {
    const std::vector<int> head = array_of<int>(file, "INTEHEAD");
    if (head.size() <= kUnitSystem) return;
    grid_.unit_system = head[kUnitSystem];
    grid_.unit_file = path.filename().string();
  }

  EclipseFiles files_;
  EclipseGrid grid_;
};

}  // namespace

EclipseGrid read_eclipse_grid(const std::filesystem::path& path) {
  return EclipseGridReader(path).read();
}

}  // namespace faultsim
