#include "simulator/grid_scene/layer_table.h"

#include <algorithm>
#include <array>
#include <optional>

#include "simulator/common/ranges.h"
#include "simulator/common/table_reader.h"
#include "simulator/common/text.h"

namespace faultsim::grid_scene {
namespace {

constexpr const char* kCure =
    "give the columns name, top [m], density [kg/m3], youngs_modulus [GPa], poisson_ratio; one "
    "layer is called reservoir";
constexpr const char* kReservoir = "reservoir";

constexpr ValueRange kDepthRange{0, 1e5, "0 to 100 km"};
constexpr ValueRange kDensityRange{100, 1e5, "100 to 100,000 kg/m3"};
constexpr ValueRange kStiffnessRange{1e3, 1e15, "1 kPa to 1e6 GPa"};

class LayerTable {
 public:
  LayerTable(std::string_view text, const std::string& source) : reader_(text, source) {}

  RockLayers read(double shallowest, double deepest, double base) {
    take_header();
    reader_.require_sound();
    while (reader_.next_row()) take_row();
    reader_.require_rows(kCure);
    check(shallowest, deepest, base);
    reader_.require_sound();
    return std::move(layers_);
  }

 private:
  static constexpr std::array<const char*, 5> kNames = {"name", "top", "density", "youngs_modulus",
                                                        "poisson_ratio"};

  void take_header() {
    if (!reader_.has_header(kCure)) return;
    for (std::size_t i = 0; i < reader_.columns().size(); ++i) {
      const auto known = std::ranges::find(kNames, reader_.columns()[i].name);
      if (known == kNames.end()) {
        reader_.refuse(table_quote(reader_.columns()[i].text) + " is not a column of a layer table",
                       kCure);
        continue;
      }
      column_[static_cast<std::size_t>(known - kNames.begin())] = i;
    }
    const std::array<Dimension, 5> dimension = {Dimension::number, Dimension::length,
                                                Dimension::density, Dimension::pressure,
                                                Dimension::number};
    const std::array<ValueRange, 5> range = {kDepthRange, kDepthRange, kDensityRange,
                                             kStiffnessRange, kDepthRange};
    for (std::size_t k = 0; k < kNames.size(); ++k) {
      if (!column_[k]) {
        reader_.refuse(std::string("there is no column ") + kNames[k], kCure);
      } else if (dimension[k] != Dimension::number) {
        reader_.set_unit(*column_[k], dimension[k], range[k], kCure);
      }
    }
  }

  void take_row() {
    RockLayer layer{.name = std::string(reader_.cell(*column_[0]))};
    if (layer.name.empty() || contains(layers_.all, layer.name, &RockLayer::name))
      reader_.refuse(table_quote(layer.name) + " is not a unique name for a layer", kCure);
    const std::array<double*, 3> into = {&layer.top, &layer.density, &layer.youngs_modulus};
    for (std::size_t k = 0; k < into.size(); ++k) {
      if (const std::optional<double> value = reader_.value(*column_[k + 1])) *into[k] = *value;
    }
    const std::string_view poisson = reader_.cell(*column_[4]);
    layer.poisson_ratio = parse_number(poisson).value_or(-1);
    if (!(layer.poisson_ratio >= 0 && layer.poisson_ratio <= 0.4999))
      reader_.refuse(table_quote(poisson) + " is not a Poisson's ratio", "write 0 to 0.4999");
    layers_.all.push_back(std::move(layer));
    lines_.push_back(reader_.line());
  }

  void check(double shallowest, double deepest, double base) {
    const auto at = std::ranges::find(layers_.all, kReservoir, &RockLayer::name);
    layers_.reservoir = static_cast<std::size_t>(at - layers_.all.begin());
    if (at == layers_.all.end() || layers_.reservoir == 0 ||
        layers_.reservoir + 1 == layers_.all.size())
      return reader_.refuse_at(0, "no layer is called reservoir, with others above and below",
                               "add it, with the rock of the flow grid's cells");
    if (layers_.all.front().top != 0)
      reader_.refuse_at(lines_.front(), "the first layer begins below the surface",
                        "let its top be 0 m: the model begins there");
    double above = -1;
    for (std::size_t k = 0; k < layers_.all.size(); ++k) {
      if (k == layers_.reservoir || k == layers_.reservoir + 1) continue;
      const RockLayer& layer = layers_.all[k];
      const bool is_above = k < layers_.reservoir;
      if (layer.top <= above)
        reader_.refuse_at(lines_[k],
                          table_quote(layer.name) + " does not begin below the layer before it",
                          "order layers from the surface down");
      if (is_above && layer.top >= shallowest)
        reader_.refuse_at(
            lines_[k],
            table_quote(layer.name) + formatted(" begins at %.0f m, where the reservoir is: it "
                                                "reaches up to %.0f m",
                                                layer.top, shallowest),
            "move it up, or put it below the reservoir");
      if (!is_above && (layer.top <= deepest || layer.top >= base))
        reader_.refuse_at(lines_[k],
                          table_quote(layer.name) +
                              formatted(" begins at %.0f m; below the reservoir there is room from "
                                        "%.0f to %.0f m",
                                        layer.top, deepest, base),
                          "move it, or let the model reach deeper (--base)");
      above = layer.top;
    }
  }

  TableReader reader_;
  std::array<std::optional<std::size_t>, 5> column_;
  RockLayers layers_;
  std::vector<int> lines_;
};

}  // namespace

RockLayers assumed_layers() {
  return {{{"overburden", 0, 2200, 10e9, 0.25},
           {"reservoir", 0, 2400, 11e9, 0.15},
           {"underburden", 0, 2600, 30e9, 0.2}},
          1};
}

RockLayers read_layers(std::string_view text, const std::string& source, double shallowest,
                       double deepest, double base) {
  return LayerTable(text, source).read(shallowest, deepest, base);
}

}  // namespace faultsim::grid_scene
