#include "simulator/result/field_integral.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "simulator/common/text.h"

namespace faultsim {
namespace {

/// "-2.41e+10 bar m3".
std::string amount(const FieldIntegral& one, double value, bool plane_strain) {
  const bool is_pressure = one.field == "pressure";
  return formatted("%.4g %s %s", value / (is_pressure ? 1e5 : 1), is_pressure ? "bar" : "K",
                   plane_strain ? "m3/m" : "m3");
}

std::string cells_beside(const FieldIntegral& one) {
  std::string text;
  if (one.n_outside > 0)
    text += concat(
        one.n_outside, " of ", one.n_cells,
        one.takes_nearest ? " cells take what the nearest flow cell has" : " cells do not change");
  if (one.n_partly > 0)
    text += concat(one.n_outside > 0 ? ", " : "", one.n_partly, " the mean of a part");
  return text;
}

std::string line_of(const FieldIntegral& one, bool plane_strain) {
  std::string text =
      formatted("%s field on %s: %.4g %% of its volume is covered; ", one.field.c_str(),
                one.region.c_str(), 100 * one.covered / one.volume) +
      "of the integral of the change that acts at the last report, " +
      amount(one, one.acts, plane_strain) + ", the flow result has " +
      formatted("%.4g", one.has / (one.field == "pressure" ? 1e5 : 1));
  if (one.assumed > 0)
    text += formatted("; %.3g %% is assumed: ", 100 * one.assumed_share()) + cells_beside(one);
  return text + "\n";
}

std::string whole_text(const FieldIntegral& one) {
  const FieldIntegral::Whole& whole = *one.whole;
  if (!(whole.flow_volume > 0)) return " (none counts with it)";
  return formatted(
      " (%.4g m3, of which %.4g %% lie in it): for this, changes are scaled by up to %.2g %%",
      whole.flow_volume, 100 * std::min(1.0, one.covered / whole.flow_volume),
      100 * whole.largest_scaling);
}

std::string line_of_whole(const FieldIntegral& one, bool plane_strain) {
  return concat(one.field, " field on ", one.region,
                ": the integral of the change that acts at the last report, ",
                amount(one, one.acts, plane_strain), ", is that of its flow cells", whole_text(one),
                one.is_whole() ? ""
                               : formatted("; %.4g %% of its volume is covered: ",
                                           100 * one.covered / one.volume) +
                                     cells_beside(one),
                "\n");
}

}  // namespace

bool FieldIntegral::is_whole() const {
  constexpr double kWhole = 1 - 1e-6;
  return covered >= kWhole * volume;
}

double FieldIntegral::assumed_share() const { return size > 0 ? assumed / size : 0; }

double assumed_share(const std::vector<FieldIntegral>& integrals) {
  double largest = 0;
  for (const char* field : {"pressure", "temperature"}) {
    FieldIntegral all;
    for (const FieldIntegral& one : integrals) {
      if (one.field != field) continue;
      all.size += one.size;
      all.assumed += one.assumed;
    }
    largest = std::max(largest, all.assumed_share());
  }
  return std::min(largest, 1.0);
}

nlohmann::json field_integrals_to_json(const std::vector<FieldIntegral>& integrals) {
  nlohmann::json rows = nlohmann::json::array();
  for (const FieldIntegral& one : integrals) {
    nlohmann::json& row = rows.emplace_back();
    row = {{"field", one.field},
           {"region", one.region},
           {"volume_m3", one.volume},
           {"covered_m3", one.covered},
           {"cells", one.n_cells},
           {"cells_outside", one.n_outside},
           {"cells_partly", one.n_partly},
           {"integral_that_acts", one.acts},
           {"integral_of_flow_cells", one.has},
           {"assumed_share", one.assumed_share()}};
    if (!one.whole) continue;
    row["flow_grid"] = {{"integral", one.whole->flow_grid},
                        {"integral_without_scaling", one.whole->mapped},
                        {"largest_scaling", one.whole->largest_scaling},
                        {"volume_m3", one.whole->flow_volume}};
  }
  return rows;
}

std::string field_integrals_to_text(const std::vector<FieldIntegral>& integrals,
                                    bool plane_strain) {
  std::string text;
  for (const FieldIntegral& one : integrals) {
    if (one.whole)
      text += line_of_whole(one, plane_strain);
    else if (!one.is_whole())
      text += line_of(one, plane_strain);
  }
  return text;
}

}  // namespace faultsim
