// One field, written as flow simulators and tables write it: every way gives the same answer.
#include <gmock/gmock.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <opm/io/eclipse/EclOutput.hpp>

#include "simulator/common/text.h"
#include "simulator/common/units.h"
#include "simulator/corner_point/corner_point_grid.h"
#include "simulator/corner_point/structure_finder.h"
#include "simulator/flow/field_file.h"
#include "simulator/grid_scene/grid_scene.h"
#include "simulator/simulation/simulation.h"

namespace faultsim {
namespace {

namespace fs = std::filesystem;

constexpr double kFoot = 0.3048, kPsi = 6894.757293168361, kBar = 1e5;
constexpr std::array<const char*, 3> kDates{"2000-01-01", "2003-01-01", "2006-01-01"};

/// Upright boxes of a regular grid; columns from the middle on lie deeper. Cells are known from
/// their centres, and all borders are whole feet.
struct BoxField {
  std::array<int, 3> size = {14, 8, 3};
  double width = 400 * kFoot;  ///< m, along x and y.
  double thickness = 80 * kFoot;
  double top = 6600 * kFoot, offset = 200 * kFoot;  ///< downwards.

  double west() const { return -0.5 * size[0] * width; }
  double south() const { return -0.5 * size[1] * width; }
  double top_of(int i) const { return top + (2 * i < size[0] ? 0 : offset); }
  Eigen::Vector3d centre(int i, int j, int k) const {
    return {west() + (i + 0.5) * width, south() + (j + 0.5) * width,
            top_of(i) + (k + 0.5) * thickness};
  }
  /// Pa, absolute.
  static double pressure(int i, int j, int k, std::size_t report) {
    const double drawn = 1 + 0.04 * i - 0.03 * j + 0.02 * k;
    return kBar * (210 + 2 * k - 50 * static_cast<double>(report) * drawn);
  }
  void each(const std::function<void(int i, int j, int k)>& use) const {
    for (int k = 0; k < size[2]; ++k) {
      for (int j = 0; j < size[1]; ++j) {
        for (int i = 0; i < size[0]; ++i) use(i, j, k);
      }
    }
  }
};

struct UnitSystem {
  std::string length, name;
  int number;  ///< of INTEHEAD.
  double metre, pascal;
};
const UnitSystem kMetric{"METRES", "METRIC", 1, 1, kBar}, kField{"FEET", "FIELD", 2, kFoot, kPsi};

void write_grid(const BoxField& field, const UnitSystem& unit, const fs::path& folder) {
  const auto& [n_i, n_j, n_k] = field.size;
  std::vector<float> coord, zcorn;
  const auto put = [&](std::vector<float>& list, double metres) {
    list.push_back(static_cast<float>(metres / unit.metre));
  };
  for (int j = 0; j <= n_j; ++j) {
    for (int i = 0; i <= n_i; ++i) {
      for (const double depth : {5000 * kFoot, 9000 * kFoot}) {
        put(coord, field.west() + i * field.width);
        put(coord, field.south() + j * field.width);
        put(coord, depth);
      }
    }
  }
  for (int plane = 0; plane < 2 * n_k; ++plane) {
    for (int row = 0; row < 2 * n_j; ++row) {
      for (int place = 0; place < 2 * n_i; ++place)
        put(zcorn, field.top_of(place / 2) + (plane + 1) / 2 * field.thickness);
    }
  }
  std::vector<int> gridhead(100, 0), filehead(100, 0);
  gridhead[0] = gridhead[24] = 1;
  std::ranges::copy(field.size, gridhead.begin() + 1);
  filehead[0] = 3;
  filehead[1] = 2007;
  Opm::EclIO::EclOutput out((folder / (unit.name + ".EGRID")).string(), false);
  out.write("FILEHEAD", filehead);
  out.write("GRIDUNIT", std::vector<std::string>{unit.length, ""});
  out.write("GRIDHEAD", gridhead);
  out.write("COORD", coord);
  out.write("ZCORN", zcorn);
  out.write("ACTNUM", std::vector<int>(static_cast<std::size_t>(n_i * n_j * n_k), 1));
  out.write("ENDGRID", std::vector<int>{});
}

void write_restart(const BoxField& field, const UnitSystem& unit, const fs::path& folder) {
  Opm::EclIO::EclOutput out((folder / (unit.name + ".UNRST")).string(), false);
  for (std::size_t t = 0; t < kDates.size(); ++t) {
    std::vector<int> head(411, 0);
    head[2] = unit.number;
    head[64] = head[65] = 1;
    head[66] = std::atoi(kDates[t]);
    out.write("SEQNUM", std::vector<int>{static_cast<int>(t)});
    out.write("INTEHEAD", head);
    std::vector<float> values;
    field.each([&](int i, int j, int k) {
      values.push_back(static_cast<float>(BoxField::pressure(i, j, k, t) / unit.pascal));
    });
    out.write("PRESSURE", values);
  }
}

std::string numbers(const std::vector<double>& values) {
  return joined(values, ", ", [](double value) { return formatted("%.17g", value); });
}

/// Centres and no sizes, a column for each date.
std::string wide_table(const BoxField& field, const UnitSystem& unit, bool has_indices) {
  const bool is_metric = unit.metre == 1;
  const std::string length = is_metric ? " [m]" : " [ft]";
  std::string text = has_indices ? "i, j, k, " : "";
  text += "x" + length + ", y" + length + ", depth" + length;
  for (const char* date : kDates) text += concat(", ", date, is_metric ? " [bar]" : " [psi]");
  text += "\n";
  field.each([&](int i, int j, int k) {
    const Eigen::Vector3d at = field.centre(i, j, k) / unit.metre;
    std::vector<double> row{at.x(), at.y(), at.z()};
    for (std::size_t t = 0; t < kDates.size(); ++t)
      row.push_back(BoxField::pressure(i, j, k, t) / unit.pascal);
    text +=
        (has_indices ? concat(i + 1, ", ", j + 1, ", ", k + 1, ", ") : "") + numbers(row) + "\n";
  });
  return text;
}

/// A line for each cell and date, the last date first.
std::string long_table(const BoxField& field) {
  std::string text = "PRESSURE [psi];K;J;I;Z [m];Y [km];X [km];DATE\n";
  for (std::size_t t = kDates.size(); t-- > 0;) {
    field.each([&](int i, int j, int k) {
      const Eigen::Vector3d at = field.centre(i, j, k);
      text +=
          formatted("%.17g;%d;%d;%d;%.17g;%.17g;%.17g;%s\n", BoxField::pressure(i, j, k, t) / kPsi,
                    k, j, i, -at.z(), at.y() / 1000, at.x() / 1000, kDates[t]);
    });
  }
  return text;
}

void write(const fs::path& path, const std::string& text) { std::ofstream(path) << text; }

/// The files of a field in a folder of its own, and what a scene in it gives with each of them.
class SameAnswer : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = testing::TempDir() + "same_answer_XXXXXX";
    folder_ = mkdtemp(name.data());
    for (const UnitSystem& unit : {kMetric, kField}) {
      write_grid(field_, unit, folder_);
      write_restart(field_, unit, folder_);
    }
    write(folder_ / "wide.csv", wide_table(field_, kMetric, false));
    write(folder_ / "indexed.csv", wide_table(field_, kField, true));
    write(folder_ / "long.csv", long_table(field_));
  }
  void TearDown() override { fs::remove_all(folder_); }

  /// χ̄ of all faults at all load steps, with another file of pressures.
  static std::vector<double> chi_bar(Simulation& simulation, const std::string& file) {
    const CaseResult result = simulation.run({{"/pressure_field/file", file}});
    EXPECT_EQ(result.outcome, Outcome::converged) << file;
    std::vector<double> chi;
    for (const StepResult& step : result.steps) {
      for (const FaultMetrics& fault : step.faults) chi.push_back(fault.chi_bar);
    }
    return chi;
  }

  static void expect_same(Simulation simulation, std::size_t n_values) {
    const std::vector<double> expected = chi_bar(simulation, "METRIC.EGRID");
    ASSERT_EQ(expected.size(), n_values);
    EXPECT_GT(expected.back(), 1.01 * expected.front()) << "pressures matter";
    for (const char* file : {"FIELD.EGRID", "FIELD.UNRST", "wide.csv", "indexed.csv", "long.csv"}) {
      const std::vector<double> chi = chi_bar(simulation, file);
      ASSERT_EQ(chi.size(), expected.size()) << file;
      for (std::size_t i = 0; i < chi.size(); ++i)
        EXPECT_NEAR(chi[i], expected[i], 1e-6 * expected[i]) << file << ", " << i;
    }
  }

  BoxField field_;
  fs::path folder_;
};

TEST_F(SameAnswer, OfASectionWhateverItsPressuresAreReadFrom) {
  write(folder_ / "section.json", R"({
  "format": 1, "tier": "custom",
  "materials": { "rock": { "density": "2300 kg/m3", "youngs_modulus": "15 GPa", "poisson_ratio": 0.2 } },
  "geometry": {
    "kind": "field", "width": "12 km", "length": "12 km", "depth": "5 km",
    "layers": [ { "name": "above", "material": "rock", "top": "0 m" },
                { "name": "reservoir", "material": "rock", "top": "6600 ft" },
                { "name": "below", "material": "rock", "top": "6840 ft" } ],
    "reservoir_layer": "reservoir", "sideburden": "rock",
    "blocks": [ { "name": "west", "from": "-2800 ft", "to": "0 m" },
                { "name": "east", "from": "0 m", "to": "2800 ft", "offset": "200 ft" } ],
    "block_length": "3200 ft", "fault_length": "4000 ft"
  },
  "mesh": { "dip": "20 m", "normal": "40 m" },
  "numerics": { "plane_strain": "on" },
  "initial_state": { "kind": "column", "ratio_across": 0.74, "ratio_along": 0.83 },
  "friction": { "cohesion": "20 MPa", "friction_angle": "30 deg" },
  "fault_pressure": { "rule": "mean" },
  "faults": [ { "name": "F1" }, { "name": "F2", "dip_from_vertical": "12 deg" }, { "name": "F3" } ],
  "pressure_field": { "file": "METRIC.EGRID", "y": "13 m" },
  "stages": [ { "name": "production", "until": "2006-01-01" } ]
})");
  expect_same(Simulation::from_file((folder_ / "section.json").string()), 3 * 2);
}

/// The scene that `faultsim init from-grid` makes of the grid.
TEST_F(SameAnswer, OfTheModelOfAGridWhateverItsPressuresAreReadFrom) {
  const corner_point::CornerPointGrid grid =
      corner_point::read_corner_point_grid(folder_ / "METRIC.EGRID");
  grid_scene::GridSceneOptions options;
  options.stem = "model";
  options.source = options.field_file = "METRIC.EGRID";
  options.lines.margin = 1000;
  options.lines.base_depth = 3500;
  options.lines.strike = 250;
  const FieldFile pressures = read_field_file(folder_ / "METRIC.EGRID", FlowQuantity::pressure);
  const grid_scene::GridScene made = grid_scene::grid_scene(
      grid, corner_point::recognise_structure(grid, {}), options, pressures.field.get());
  write(folder_ / "model.json", grid_scene::scene_text(made.scene));
  for (const grid_scene::SceneTable& table : made.tables) write(folder_ / table.name, table.text);
  expect_same(Simulation::from_file((folder_ / "model.json").string()), 2);
}

}  // namespace
}  // namespace faultsim
